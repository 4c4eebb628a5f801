// benchmarks/kernel_benchmarks.cpp - registers every kernel for every width that the CPU has.
// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include "benchmarks/benchmarks.h"

namespace obscura {

// Declared as in stages/dispatch.h: this file is compiled as baseline.
inline namespace isa_baseline {
extern const benchmarks::KernelTable kernel_table;
}
namespace isa_avx2 {
extern const benchmarks::KernelTable kernel_table;
}
namespace isa_avx512 {
extern const benchmarks::KernelTable kernel_table;
}

namespace benchmarks {

namespace {

const KernelTable& kernel_table_for(Isa isa) {
#if defined(__x86_64__)
    if (isa == Isa::avx512) return isa_avx512::kernel_table;
    if (isa == Isa::avx2) return isa_avx2::kernel_table;
#endif
    (void)isa;
    return isa_baseline::kernel_table;
}

void register_kernel(const std::string& name, KernelFunction function, const KernelData& data) {
    benchmark::RegisterBenchmark(name.c_str(), [function, &data](benchmark::State& state) {
        for (auto _ : state) {
            function(data);
            benchmark::ClobberMemory();
        }
        state.SetItemsProcessed(state.iterations() * kernel_size);
    });
}

}  // namespace

void register_kernels(const KernelData& data) {
    for (int k = 0; k < kernel_count; ++k) {
        for (const Isa isa : all_isas) {
            if (!has_isa(isa)) continue;
            const KernelTable& table = kernel_table_for(isa);
            const Kernel& kernel = table.kernels[k];
            const std::string name = std::string("kernel/") + kernel.name + "/" + table.isa + "/";
            register_kernel(name + "1", kernel.one, data);
            register_kernel(name + std::to_string(table.lanes), kernel.lanes, data);
        }
    }
    for (const Isa isa : all_isas) {
        if (!has_isa(isa)) register_missing_isa("kernel", isa);
    }
}

}  // namespace benchmarks
}  // namespace obscura
