#pragma once

namespace groundloop::bench {

/// Lets the calling thread, and every thread that it starts from now on (llvmpipe's among them), stand back
/// behind whoever waits for its work: the simulator must not delay the SLAM whose times are measured. Changes
/// when things are done, never what comes out.
void stand_back();

}  // namespace groundloop::bench
