// surface/albedo_table.h - directional albedo of single-scattering lobes, by cosine and roughness.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/gather4.h"
#include "math/vec.h"

namespace obscura {

/// Normal-incidence reflectance of a dielectric with index of refraction 1.5.
inline constexpr float dielectric_f0 = 0.04f;

/// Entry (r, c) is for the cosine (c / (albedo_cosines - 1))^2, dense where lobes change fastest,
/// and the perceptual roughness r / (albedo_roughnesses - 1). A cell r * albedo_cosines + c holds
/// its corners (r, c), (r, c + 1), (r + 1, c), (r + 1, c + 1) beside each other, so that a look-up
/// reads them at once.
inline constexpr int albedo_cosines = 32;
inline constexpr int albedo_roughnesses = 48;
inline constexpr int albedo_cells = albedo_cosines * (albedo_roughnesses - 1);

// The tables are written by tools/make_albedo_tables.cpp while the project is built.

/// Of microfacets: the corners of SpecularAlbedo::mirror, then those of SpecularAlbedo::grazing.
extern const float specular_cells[albedo_cells * 8];
/// Of the Charlie lobe (surface/sheen.h) with a white colour.
extern const float sheen_cells[albedo_cells * 4];

inline namespace OBSCURA_ISA {

/// A position in the tables.
template <typename F>
struct AlbedoCell {
    IntOf<F> index;
    F x, y;  ///< from the first corner to the next cosine, the next roughness; 0 to 1
};

template <typename F>
OBSCURA_INLINE AlbedoCell<F> albedo_cell(const F& cosine, const F& roughness) {
    using I = IntOf<F>;
    const F x = sqrt(clamp(cosine, F(0.0f), F(1.0f))) * F(static_cast<float>(albedo_cosines - 1));
    const F y = clamp(roughness, F(0.0f), F(1.0f)) * F(static_cast<float>(albedo_roughnesses - 1));
    const I column = min(to_int(x), I(albedo_cosines - 2));
    const I row = min(to_int(y), I(albedo_roughnesses - 2));
    return {row * I(albedo_cosines) + column, x - from_int<F>(column), y - from_int<F>(row)};
}

template <typename F>
OBSCURA_INLINE F bilinear(const Four<F>& corner, const F& x, const F& y) {
    return lerp(lerp(corner.x, corner.y, x), lerp(corner.z, corner.w, x), y);
}

/// Directional albedo of single-scattering microfacets. Like Schlick's Fresnel, it is linear in the
/// reflectances f0 at normal and f90 at grazing incidence.
///
/// Source  Karis, "Real Shading in Unreal Engine 4", SIGGRAPH 2013 course
template <typename F>
struct SpecularAlbedo {
    F mirror;   ///< of facets that reflect everything
    F grazing;  ///< of facets with f0 = 0, f90 = 1

    OBSCURA_INLINE F operator()(const F& f0, const F& f90) const {
        return f0 * (mirror - grazing) + f90 * grazing;
    }
};

template <typename F>
OBSCURA_INLINE SpecularAlbedo<F> specular_albedo(const F& cosine, const F& alpha) {
    const AlbedoCell<F> cell = albedo_cell(cosine, sqrt(alpha));
    const auto corners = [&](int first) {
        return gather4<F>(specular_cells + first, IntOf<F>(cell.index * IntOf<F>(8)));
    };
    return {bilinear(corners(0), cell.x, cell.y), bilinear(corners(4), cell.x, cell.y)};
}

/// Cosine-weighted mean of Schlick's reflectance from f0 to f90.
template <typename F>
OBSCURA_INLINE F mean_schlick(const F& f0, const F& f90) {
    return f0 + (f90 - f0) * F(1.0f / 21);
}

template <typename F>
OBSCURA_INLINE Vec3<F> mean_schlick(const Vec3<F>& f0) {
    return f0 * F(20.0f / 21) + splat3(F(1.0f / 21));
}

/// The factor on a single-scattering lobe that adds light reflected between microfacets. A lobe
/// whose facets absorb nothing then absorbs nothing at all.
///
/// In      mirror: SpecularAlbedo::mirror towards wo; mean_reflectance: of a facet, over all angles
/// Source  Turquin, "Practical Multiple Scattering Compensation for Microfacet Models", 2019, with
///         the sum over bounces of Fdez-Aguera, "A Multiple-Scattering Microfacet Model for
///         Real-Time Image-based Lighting", JCGT 8(1), 2019: the fraction 1 - mirror that is caught
///         meets another facet. Not reciprocal: the factor belongs to wo.
template <typename F>
OBSCURA_INLINE F interreflection(const F& mirror, const F& mean_reflectance) {
    return F(1.0f) / (F(1.0f) - mean_reflectance * (F(1.0f) - mirror));
}

template <typename F>
OBSCURA_INLINE Vec3<F> interreflection(const F& mirror, const Vec3<F>& mean_reflectance) {
    return {interreflection(mirror, mean_reflectance.x),
            interreflection(mirror, mean_reflectance.y),
            interreflection(mirror, mean_reflectance.z)};
}

/// A dielectric's lobe with f0 = dielectric_f0: its interreflection factor and directional albedo.
template <typename F>
struct DielectricLobe {
    F factor;  ///< interreflection
    F albedo;
};

template <typename F>
OBSCURA_INLINE DielectricLobe<F> dielectric_lobe(const SpecularAlbedo<F>& once) {
    constexpr float mean = dielectric_f0 + (1.0f - dielectric_f0) / 21;
    const F factor = interreflection(once.mirror, F(mean));
    return {factor, factor * once(F(dielectric_f0), F(1.0f))};
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
