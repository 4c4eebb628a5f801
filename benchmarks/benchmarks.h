// benchmarks/benchmarks.h - what the micro-benchmark program measures, and how it registers it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/render.h"
#include "stages/dispatch.h"

#include "benchmarks/kernel_data.h"
#include <string>

namespace obscura::benchmarks {

inline constexpr Isa all_isas[] = {Isa::baseline, Isa::avx2, Isa::avx512};

/// As --isa spells it.
const char* isa_name(Isa isa);

/// Registers an entry that only says that this CPU cannot run them.
void register_missing_isa(const std::string& group, Isa isa);

/// "kernel/NAME/ISA/WIDTH": every kernel, one entry at a time and a register of entries at a time.
///
/// In      data: lives until all benchmarks have run
void register_kernels(const KernelData& data);

/// "stage/NAME/ISA": every stage on the columns of one tile of `scene`.
///
/// In      scene: lives until all benchmarks have run; isa: what it was prepared for
void register_stages(const PreparedScene& scene, const Camera& camera, Isa isa);

/// "particles/RAYS/WAY": a million spheres on one thread, in blocks as user geometry and as
/// Embree's own sphere points, with bytes per sphere.
void register_particles();

}  // namespace obscura::benchmarks
