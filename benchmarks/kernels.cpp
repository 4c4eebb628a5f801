// benchmarks/kernels.cpp - loops over the renderer's kernels; compiled once per instruction set.
// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/kernels.h"

#include "math/sampler.h"
#include "surface/bsdf.h"

#define OBSCURA_TEXT_OF(name) #name
#define OBSCURA_TEXT(name) OBSCURA_TEXT_OF(name)

namespace obscura {
inline namespace OBSCURA_ISA {

static_assert(lane_count == OBSCURA_LANES, "compiled for another instruction set than intended");

namespace {

using benchmarks::KernelData;

/// The entries that start at p: one, or a register full of them.
template <typename F, typename T>
OBSCURA_INLINE auto read(const T* p) {
    if constexpr (std::is_same_v<F, float>) {
        return *p;
    } else {
        return load(p);
    }
}

template <typename F>
OBSCURA_INLINE void write(float* p, const F& value) {
    if constexpr (std::is_same_v<F, float>) {
        *p = value;
    } else {
        store(p, value);
    }
}

template <typename F>
OBSCURA_INLINE Vec3<F> read3(const float* x, const float* y, const float* z, int i) {
    return {read<F>(x + i), read<F>(y + i), read<F>(z + i)};
}

template <typename F>
OBSCURA_INLINE F sum3(const Vec3<F>& v) {
    return v.x + v.y + v.z;
}

/// Calls body(i) for the first entry of every group of F. A body stores sums of what it computes,
/// so that nothing is optimised away; one or two stores cost little beside the kernel.
template <typename F, typename Body>
OBSCURA_INLINE void for_groups(const Body& body) {
    for (int i = 0; i < benchmarks::kernel_size; i += LaneTypes<F>::size) {
        body(i);
    }
}

template <typename F>
OBSCURA_INLINE BsdfParams<F> material(const KernelData& d, int i) {
    return {read3<F>(d.red, d.green, d.blue, i), read<F>(d.metallic + i), read<F>(d.alpha + i)};
}

template <typename F>
OBSCURA_INLINE LobeWeights<F> weights(const KernelData& d, int i) {
    return {read<F>(d.diffuse + i),
            read<F>(d.specular_probability + i),
            read3<F>(d.f0_red, d.f0_green, d.f0_blue, i),
            read3<F>(d.rise_red, d.rise_green, d.rise_blue, i)};
}

template <typename F>
void bsdf_weights(const KernelData& d) {
    for_groups<F>([&](int i) {
        const LobeWeights<F> lobes = lobe_weights(material<F>(d, i), read<F>(d.wo_z + i));
        write(d.out0 + i, lobes.diffuse);
        write(d.out1 + i,
              lobes.specular_probability + sum3(lobes.specular_f0) + sum3(lobes.specular_rise));
    });
}

template <typename F>
void bsdf_evaluate(const KernelData& d) {
    for_groups<F>([&](int i) {
        const Vec3<F> wo = read3<F>(d.wo_x, d.wo_y, d.wo_z, i);
        const Vec3<F> wi = read3<F>(d.wi_x, d.wi_y, d.wi_z, i);
        const BsdfValue<F> at = evaluate_bsdf(material<F>(d, i), weights<F>(d, i), wo, wi);
        write(d.out0 + i, sum3(at.value_cos));
        write(d.out1 + i, at.pdf);
    });
}

template <typename F>
void bsdf_sample(const KernelData& d) {
    for_groups<F>([&](int i) {
        const Vec3<F> wo = read3<F>(d.wo_x, d.wo_y, d.wo_z, i);
        const Vec2<F> u{read<F>(d.u0 + i), read<F>(d.u1 + i)};
        const BsdfSample<F> sample = sample_bsdf(material<F>(d, i), weights<F>(d, i), wo, u);
        write(d.out0 + i, sum3(sample.direction) + sample.spread);
        write(d.out1 + i, sum3(sample.at.value_cos) + sample.at.pdf);
    });
}

template <typename F>
void ggx_sample_normal(const KernelData& d) {
    for_groups<F>([&](int i) {
        const Vec3<F> wo = read3<F>(d.wo_x, d.wo_y, d.wo_z, i);
        const Vec2<F> u{read<F>(d.u0 + i), read<F>(d.u1 + i)};
        const F alpha = read<F>(d.alpha + i);
        write(d.out0 + i, sum3(sample_visible_normal<F>(wo, {alpha, alpha}, u)));
    });
}

template <typename F>
void texture_stochastic(const KernelData& d) {
    for_groups<F>([&](int i) {
        const Rgba<F> texel =
            sample_texture_stochastic<F>(d.textures,
                                         read<F>(d.texture + i),
                                         {read<F>(d.texture_u + i), read<F>(d.texture_v + i)},
                                         read<F>(d.footprint + i),
                                         read3<F>(d.u0, d.u1, d.u2, i));
        write(d.out0 + i, sum3(texel.rgb) + texel.alpha);
    });
}

template <typename F>
void texture_bilinear(const KernelData& d) {
    for_groups<F>([&](int i) {
        const Rgba<F> texel =
            sample_texture_bilinear<F>(d.textures,
                                       read<F>(d.texture + i),
                                       {read<F>(d.texture_u + i), read<F>(d.texture_v + i)},
                                       read<F>(d.footprint + i));
        write(d.out0 + i, sum3(texel.rgb) + texel.alpha);
    });
}

template <typename F>
void random_pair(const KernelData& d) {
    for_groups<F>([&](int i) {
        const Vec2<F> u = unit_pair<F>(sobol_pair(read<F>(d.bits0 + i), read<F>(d.bits1 + i), 7));
        write(d.out0 + i, u.x);
        write(d.out1 + i, u.y);
    });
}

template <typename F>
void environment_sample(const KernelData& d) {
    for_groups<F>([&](int i) {
        const Vec2<UintOf<F>> random{read<F>(d.bits0 + i), read<F>(d.bits1 + i)};
        const EnvironmentSample<F> sample = sample_environment<F>(d.environment, random);
        write(d.out0 + i, sum3(sample.direction));
        write(d.out1 + i, sum3(sample.radiance) + sample.pdf);
    });
}

template <typename F>
void environment_look_up(const KernelData& d) {
    for_groups<F>([&](int i) {
        const EnvironmentTaps<F> taps =
            environment_taps(d.environment, read3<F>(d.world_x, d.world_y, d.world_z, i));
        F sum(0.0f);
        for (int tap = 0; tap < 4; ++tap)
            sum = sum + taps.weight[tap] * (sum3(taps.radiance[tap]) + taps.pdf[tap]);
        write(d.out0 + i, sum);
    });
}

template <typename F>
void environment_pixel(const KernelData& d) {
    for_groups<F>([&](int i) {
        const EnvironmentCell<F> cell =
            environment_cell(d.environment, read3<F>(d.world_x, d.world_y, d.world_z, i));
        const IntOf<F> word = choose_environment_pixel(cell, UintOf<F>(read<F>(d.bits0 + i)));
        const Four<F> pixel = gather4<F>(d.environment.pixels, word);
        const F density = environment_density(pixel.w, cell.sin_theta);
        write(d.out0 + i, pixel.x + pixel.y + pixel.z + density);
    });
}

template <typename F>
void choice_draw(const KernelData& d) {
    for_groups<F>([&](int i) {
        const IntOf<F> index = sample_cdf<F>(d.choice, d.choice_count, read<F>(d.bits0 + i));
        write(d.out0 + i, from_int<F>(index));
    });
}

}  // namespace

#define OBSCURA_KERNEL(name) \
    { #name, name < float>, name < Lanes> }

extern const benchmarks::KernelTable kernel_table;
const benchmarks::KernelTable kernel_table = {
    &OBSCURA_TEXT(OBSCURA_ISA)[4],  // without "isa_"
    lane_count,
    {OBSCURA_KERNEL(bsdf_weights),
     OBSCURA_KERNEL(bsdf_evaluate),
     OBSCURA_KERNEL(bsdf_sample),
     OBSCURA_KERNEL(ggx_sample_normal),
     OBSCURA_KERNEL(texture_stochastic),
     OBSCURA_KERNEL(texture_bilinear),
     OBSCURA_KERNEL(random_pair),
     OBSCURA_KERNEL(environment_sample),
     OBSCURA_KERNEL(environment_look_up),
     OBSCURA_KERNEL(environment_pixel),
     OBSCURA_KERNEL(choice_draw)},
};

}  // namespace OBSCURA_ISA
}  // namespace obscura
