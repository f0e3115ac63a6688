#pragma once

/// Marks a hot plain loop to be compiled twice, for AVX2 + FMA and for the baseline machine, with the choice
/// made when the program starts: a binary never meets an instruction its machine does not know. Sanitizers
/// cannot start before such a choice is made, so their builds use the baseline.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(GROUNDLOOP_SANITIZED)
#define GROUNDLOOP_MULTIVERSION __attribute__((target_clones("default", "arch=x86-64-v3"), optimize("O3")))
#else
#define GROUNDLOOP_MULTIVERSION
#endif
