// benchmarks/kernel_data.h - the kernels' input: columns of random but repeatable numbers.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "light/environment_table.h"
#include "scene/scene.h"

#include "benchmarks/kernels.h"
#include <deque>
#include <vector>

namespace obscura::benchmarks {

/// The same numbers in every run. Materials and directions are what a varied scene shows; texture
/// coordinates are independent of each other, so look-ups are as incoherent as after a bounce.
class KernelColumns {
public:
    /// In      scene, environment: outlive this object; the scene has at least one texture
    KernelColumns(const Scene& scene, const EnvironmentTable& environment);

    KernelColumns(const KernelColumns&) = delete;
    KernelColumns& operator=(const KernelColumns&) = delete;

    const KernelData& data() const { return data_; }

private:
    template <typename Function>
    const float* column(const Function& value_of);
    void make_directions();
    void make_materials();
    void make_look_ups(const Scene& scene);

    std::deque<std::vector<float>> floats_;  ///< a deque: columns stay where they are
    std::vector<int32_t> texture_;
    std::vector<uint32_t> bits_[2];
    std::vector<CdfEntry> choice_;
    uint32_t state_ = 0;
    KernelData data_{};

    float next();  ///< uniform in [0, 1)
};

}  // namespace obscura::benchmarks
