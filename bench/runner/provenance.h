#pragma once

#include <string>

namespace groundloop::bench {

/// SHA-256 of a file, in hexadecimal; empty when it cannot be read.
std::string sha256_of_file(const std::string& file);

/// SHA-256 of a text, in hexadecimal.
std::string sha256_of_text(const std::string& text);

/// The instruction set that numbers were computed with: what the processor offers of those we, OpenCV and the
/// renderer choose between ("x86-64 avx2 fma").
std::string instruction_set();

/// Resident memory of this process now [MiB].
double memory_mb();

/// Largest resident memory of this process so far [MiB].
double peak_memory_mb();

}  // namespace groundloop::bench
