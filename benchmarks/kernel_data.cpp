// benchmarks/kernel_data.cpp - fills the columns that kernels read.
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/kernel_data.h"

#include "math/sampler.h"
#include "math/warp.h"
#include "surface/bsdf.h"

#include <cmath>

namespace obscura::benchmarks {

namespace {

constexpr size_t choices = 4096;  // as many lights as a large scene has

}  // namespace

float KernelColumns::next() {
    return unit_float<float>(hash_word(++state_));
}

template <typename Function>
const float* KernelColumns::column(const Function& value_of) {
    std::vector<float>& values = floats_.emplace_back(kernel_size);
    for (size_t i = 0; i < values.size(); ++i)
        values[i] = value_of(i);
    return values.data();
}

void KernelColumns::make_directions() {
    std::vector<Vec3f> wo;
    std::vector<Vec3f> wi;
    std::vector<Vec3f> world;
    for (int i = 0; i < kernel_size; ++i) {
        wo.push_back(cosine_hemisphere(Vec2f{next(), next()}));
        wi.push_back(cosine_hemisphere(Vec2f{next(), next()}));
        const float z = 2.0f * next() - 1.0f;
        const SinCos<float> turn = sin_cos_turn(next());
        const float radius = std::sqrt(1.0f - z * z);
        world.push_back({radius * turn.cos, z, radius * turn.sin});
    }
    const auto split = [&](const std::vector<Vec3f>& v, auto& x, auto& y, auto& z) {
        x = column([&](size_t i) { return v[i].x; });
        y = column([&](size_t i) { return v[i].y; });
        z = column([&](size_t i) { return v[i].z; });
    };
    split(wo, data_.wo_x, data_.wo_y, data_.wo_z);
    split(wi, data_.wi_x, data_.wi_y, data_.wi_z);
    split(world, data_.world_x, data_.world_y, data_.world_z);
}

void KernelColumns::make_materials() {
    const auto uniform = [&](size_t) { return next(); };
    data_.red = column(uniform);
    data_.green = column(uniform);
    data_.blue = column(uniform);
    // Half of the entries are dielectric or metal without any mixture, as most surfaces are.
    data_.metallic = column([&](size_t i) { return i % 2 == 0 ? next() : std::round(next()); });
    data_.alpha = column([&](size_t) {
        const float roughness = next();
        return max(roughness * roughness, min_ggx_alpha);
    });
    const auto lobes = [&](size_t i) {
        const BsdfParams<float> p{
            {data_.red[i], data_.green[i], data_.blue[i]}, data_.metallic[i], data_.alpha[i]};
        return lobe_weights(p, data_.wo_z[i]);
    };
    data_.diffuse = column([&](size_t i) { return lobes(i).diffuse; });
    data_.specular_probability = column([&](size_t i) { return lobes(i).specular_probability; });
    data_.f0_red = column([&](size_t i) { return lobes(i).specular_f0.x; });
    data_.f0_green = column([&](size_t i) { return lobes(i).specular_f0.y; });
    data_.f0_blue = column([&](size_t i) { return lobes(i).specular_f0.z; });
    data_.rise_red = column([&](size_t i) { return lobes(i).specular_rise.x; });
    data_.rise_green = column([&](size_t i) { return lobes(i).specular_rise.y; });
    data_.rise_blue = column([&](size_t i) { return lobes(i).specular_rise.z; });
    data_.u0 = column(uniform);
    data_.u1 = column(uniform);
    data_.u2 = column(uniform);
}

void KernelColumns::make_look_ups(const Scene& scene) {
    const std::vector<TextureRecord>& records = scene.textures.records;
    for (size_t i = 0; i < kernel_size; ++i)
        texture_.push_back(static_cast<int32_t>(i * 7 % records.size()));
    data_.texture = texture_.data();
    data_.texture_u = column([&](size_t) { return 4.0f * next() - 2.0f; });
    data_.texture_v = column([&](size_t) { return 4.0f * next() - 2.0f; });
    // From a texel magnified twice to one pixel over eight texels.
    data_.footprint = column([&](size_t i) {
        const TextureRecord& record = records[static_cast<size_t>(texture_[i])];
        const float side = std::exp2(4.0f * next() - 1.0f);
        return side * side / static_cast<float>(record.width) / static_cast<float>(record.height);
    });
    data_.textures = {scene.textures.texels.data(), records.data()};
    for (std::vector<uint32_t>& words : bits_) {
        for (int i = 0; i < kernel_size; ++i)
            words.push_back(hash_word(++state_));
    }
    data_.bits0 = bits_[0].data();
    data_.bits1 = bits_[1].data();
}

KernelColumns::KernelColumns(const Scene& scene, const EnvironmentTable& environment) {
    make_directions();
    make_materials();
    make_look_ups(scene);
    data_.out0 = floats_.emplace_back(kernel_size).data();
    data_.out1 = floats_.emplace_back(kernel_size).data();
    data_.environment = environment.view();
    std::vector<double> powers;
    for (size_t i = 0; i < choices; ++i)
        powers.push_back(next() * next());
    choice_ = build_cdf_table(std::span<const double>(powers));
    data_.choice = choice_.data();
    data_.choice_count = static_cast<int32_t>(choices);
}

}  // namespace obscura::benchmarks
