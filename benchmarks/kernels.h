// benchmarks/kernels.h - the numeric kernels that are measured, as one table per instruction set.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "light/cdf_table.h"
#include "light/environment.h"
#include "surface/texture.h"

#include <cstdint>

namespace obscura::benchmarks {

/// Entries in every column: half of the renderer's batch, so that all columns stay within a
/// core's second-level cache.
inline constexpr int kernel_size = 1024;

/// What kernels read and write: columns of kernel_size numbers, and the tables they gather from.
/// Only raw pointers, for the reason given in docs/design.md, "Instruction sets".
struct KernelData {
    const float *wo_x, *wo_y, *wo_z;           ///< unit, above the horizon
    const float *wi_x, *wi_y, *wi_z;           ///< likewise
    const float *world_x, *world_y, *world_z;  ///< unit, all around
    const float *red, *green, *blue, *metallic, *alpha;
    const float *diffuse, *specular_probability;  ///< lobe weights of these materials
    const float *f0_red, *f0_green, *f0_blue, *rise_red, *rise_green, *rise_blue;
    const float *u0, *u1, *u2;  ///< uniform in [0, 1)
    const float *texture_u, *texture_v, *footprint;
    const int32_t* texture;
    const uint32_t *bits0, *bits1;  ///< uniform 32-bit words
    float *out0, *out1;
    TextureView textures;
    EnvironmentView environment;
    const CdfEntry* choice;
    int32_t choice_count;
};

/// Runs over all entries once.
using KernelFunction = void (*)(const KernelData&);

/// To add a kernel: write it in kernels.cpp, list it at that file's end, and count it here.
struct Kernel {
    const char* name;
    KernelFunction one;    ///< one entry at a time: F = float
    KernelFunction lanes;  ///< as many at a time as the instruction set has lanes
};
inline constexpr int kernel_count = 11;

struct KernelTable {
    const char* isa;
    int lanes;
    Kernel kernels[kernel_count];
};

}  // namespace obscura::benchmarks
