#pragma once

namespace groundloop::bench {

/// The program `groundloop`: reads the command line, does what it says, reports errors on stderr.
/// @return exit code: 0 pass, 1 the SLAM fell short, 2 bad input, 3 internal error, 130 stopped by Ctrl-C
int run_cli(int argc, char** argv);

}  // namespace groundloop::bench
