// tests/support/layered_materials.h - layered materials for tests, in any precision.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "surface/layered_bsdf.h"

#include "support/random.h"
#include <algorithm>
#include <cmath>

namespace obscura::test {

/// A white dielectric of index 1.5 without any layer.
inline LayeredParams<float> plain_layers(float alpha) {
    const Vec3f white{1, 1, 1};
    LayeredParams<float> p{};
    p.base_color = white;
    p.alpha = {alpha, alpha};
    p.f0 = splat3(dielectric_f0);
    p.f90 = 1;
    p.eta = 1.5F;
    p.solid = false;
    p.diffuse_transmission_color = white;
    p.sheen_alpha = 1;
    p.coat_alpha = 1;
    p.coat_normal = {0, 0, 1};
    p.thin_film = {0, 1.3F, 400};
    return p;
}

/// A mirror-smooth white pane (eta 0) or solid that transmits everything.
inline LayeredParams<float> clear_glass(float alpha, float eta) {
    LayeredParams<float> p = plain_layers(alpha);
    p.transmission = 1;
    p.solid = eta > 0;
    if (eta > 0) p.eta = eta;
    p.f0 = splat3(normal_reflectance(p.eta));
    p.f90 = grazing_reflectance(p.eta);
    return p;
}

/// All lobes with random weights; colours at most 1.
inline LayeredParams<float> random_layers(Pcg32& random, float min_alpha) {
    const auto unit = [&] {
        const uint32_t kind = random.next_uint() % 5;
        return kind == 0 ? 0.0F : kind == 1 ? 1.0F : random.next_float();
    };
    const auto color = [&] {
        const float red = unit();
        const float green = unit();
        return Vec3f{red, green, unit()};
    };
    const auto width = [&] { return std::max(square(unit()), min_alpha); };
    LayeredParams<float> p = plain_layers(width());
    p.alpha.x = std::max(p.alpha.x, width());
    p.base_color = color();
    p.metallic = unit();
    p.solid = random.next_uint() % 2 == 0;
    p.eta = std::exp2(2 * random.next_float() - 1);
    if (std::fabs(p.eta - 1) < 0.02F) p.eta = 1.02F;
    p.f90 = unit();  // the extension's specular factor
    p.f0 = color() * (p.f90 * normal_reflectance(p.eta));
    p.f90 *= grazing_reflectance(p.eta);
    p.transmission = unit();
    p.diffuse_transmission = unit();
    p.diffuse_transmission_color = color();
    p.sheen_color = color();
    p.sheen_alpha = std::max(square(unit()), min_sheen_alpha);
    p.coat = unit();
    p.coat_alpha = width();
    const float lean = 0.2F * random.next_float();
    p.coat_normal = normalize(Vec3f{lean, -0.5F * lean, 1});
    p.thin_film = {unit(), 1 + unit(), 1000 * unit()};
    return p;
}

template <typename F>
Vec3<F> convert(const Vec3f& v) {
    return {F(v.x), F(v.y), F(v.z)};
}

template <typename F>
LayeredParams<F> convert(const LayeredParams<float>& p) {
    LayeredParams<F> out;
    out.base_color = convert<F>(p.base_color);
    out.metallic = F(p.metallic);
    out.alpha = {F(p.alpha.x), F(p.alpha.y)};
    out.f0 = convert<F>(p.f0);
    out.f90 = F(p.f90);
    out.eta = F(p.eta);
    out.solid = MaskOf<F>(p.solid);
    out.transmission = F(p.transmission);
    out.diffuse_transmission = F(p.diffuse_transmission);
    out.diffuse_transmission_color = convert<F>(p.diffuse_transmission_color);
    out.sheen_color = convert<F>(p.sheen_color);
    out.sheen_alpha = F(p.sheen_alpha);
    out.coat = F(p.coat);
    out.coat_alpha = F(p.coat_alpha);
    out.coat_normal = convert<F>(p.coat_normal);
    out.thin_film = {F(p.thin_film.strength), F(p.thin_film.ior), F(p.thin_film.thickness_nm)};
    return out;
}

/// A point of the unit cube, for sample_layered.
inline Vec3f random_point(Pcg32& random) {
    const float x = random.next_float();
    const float y = random.next_float();
    return {x, y, random.next_float()};
}

/// A direction above the horizon whose cosine is at least `least`.
inline Vec3f direction_above(Pcg32& random, float least) {
    const float z = least + (1 - least) * random.next_float();
    const SinCos<float> turn = sin_cos_turn(random.next_float());
    const float radius = std::sqrt(std::max(0.0F, 1 - z * z));
    return {radius * turn.cos, radius * turn.sin, z};
}

}  // namespace obscura::test
