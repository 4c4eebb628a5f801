// base/per_cpu.h - functions that are compiled for several generations of processors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Before the definition of a function with hot loops: it is compiled for each generation of
/// x86-64, and the best one that the processor has is called. Where products and sums are not fused
/// (-ffp-contract=off), all of them give the same bits. Compilers other than GCC make one, and so
/// do sanitizers, which are not ready yet when the choice is made.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__linux__) && \
    defined(__OPTIMIZE__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define OBSCURA_PER_CPU \
    __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define OBSCURA_PER_CPU
#endif
