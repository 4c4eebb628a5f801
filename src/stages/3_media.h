// stages/3_media.h - the stack of media that a path is inside of: enter, leave, absorb, refract.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/3_tables.h"
#include "surface/fresnel.h"

namespace obscura {
inline namespace OBSCURA_ISA {

// The medium stack: the media that a path is inside of, as nested dielectrics with priorities.
// PathColumns::medium_stack holds, from the upper end:
//   bit  26     seen_unclearly, of path_state.h
//   bit  25     1 once the path has scattered roughly, where BatchSettings asks for that
//   bit  24     1 once the path has been given one wavelength (dispersion)
//   bits 23-0   the numbers of up to three media that overlap here, the greatest first; 0: none
// The greatest number dominates (scene/media.h). Of more than three, the least is dropped.

inline constexpr uint32_t one_wavelength = 1U << 24;
inline constexpr uint32_t scattered_roughly = 1U << 25;

/// Number of the dominant medium.
OBSCURA_INLINE LanesI dominant_medium(LanesU medium_stack) {
    return as_int((medium_stack >> 16) & LanesU(255U));
}

OBSCURA_INLINE LanesU pack_medium_stack(LanesU medium_stack,
                                        LanesI first,
                                        LanesI second,
                                        LanesI third) {
    return (medium_stack & LanesU(~0xFFFFFFU)) | as_uint(first) << 16 | as_uint(second) << 8 |
           as_uint(third);
}

/// The stack after one more medium is entered.
OBSCURA_INLINE LanesU enter_medium(LanesU medium_stack, LanesI medium) {
    const LanesI first = dominant_medium(medium_stack);
    const LanesI second = as_int((medium_stack >> 8) & LanesU(255U));
    const LanesI third = as_int(medium_stack & LanesU(255U));
    const LanesI lower = min(first, medium);
    return pack_medium_stack(
        medium_stack, max(first, medium), max(second, lower), max(third, min(second, lower)));
}

/// The stack after a medium is left; one that was never entered changes nothing.
OBSCURA_INLINE LanesU leave_medium(LanesU medium_stack, LanesI medium) {
    const LanesI first = dominant_medium(medium_stack);
    const LanesI second = as_int((medium_stack >> 8) & LanesU(255U));
    const LanesI third = as_int(medium_stack & LanesU(255U));
    const Mask is_first = first == medium;
    const Mask is_second = is_first | (second == medium);
    const Mask is_third = is_second | (third == medium);
    return pack_medium_stack(medium_stack,
                             select(is_first, second, first),
                             select(is_second, third, second),
                             select(is_third, LanesI(0), third));
}

/// Four words of a medium, from a member on. Always gathered: lanes seldom travel in one medium.
template <auto member>
OBSCURA_INLINE Four<Lanes> gather_medium(const SceneView& scene, LanesI medium) {
    return gather4<Lanes>(reinterpret_cast<const float*>(scene.media) + word_of<member>,
                          LanesI(medium * LanesI(words_per_record<Medium>)));
}

/// Extinction per metre, and the index of refraction in w.
OBSCURA_INLINE Four<Lanes> read_medium(const SceneView& scene, LanesI medium) {
    static_assert(word_of<&Medium::ior> == word_of<&Medium::extinction> + 3);
    return gather_medium<&Medium::extinction>(scene, medium);
}

/// Scattering albedo, and the mean cosine of the phase function in w.
OBSCURA_INLINE Four<Lanes> read_scattering(const SceneView& scene, LanesI medium) {
    static_assert(word_of<&Medium::anisotropy> == word_of<&Medium::albedo> + 3);
    return gather_medium<&Medium::albedo>(scene, medium);
}

OBSCURA_INLINE Mask scatters(const Four<Lanes>& scattering) {
    return max(scattering.x, max(scattering.y, scattering.z)) > Lanes(0.0f);
}

/// Transmittance of a distance through the dominant medium.
/// Source  the Beer-Lambert law
OBSCURA_INLINE Vec3<Lanes> transmittance(const SceneView& scene,
                                         LanesU medium_stack,
                                         Lanes distance_m) {
    const Four<Lanes> medium = read_medium(scene, dominant_medium(medium_stack));
    return {exp(-(medium.x * distance_m)),
            exp(-(medium.y * distance_m)),
            exp(-(medium.z * distance_m))};
}

/// True for media with the index of air.
///
/// In      ior: from read_medium
OBSCURA_INLINE Mask is_like_air(Lanes ior) {
    return abs(ior - Lanes(1.0f)) < Lanes(min_refraction);
}

/// Longer rays end at lights at infinity; see directional_distance_m.
inline constexpr float farthest_lamp_m = 1e18f;

/// Transmittance of the medium around a path towards a light, or towards a hit before it. Lights at
/// infinity get 1: they lie outside of all media, and the shadow ray meets the medium's boundary.
OBSCURA_INLINE Vec3<Lanes> transmittance_to_light(const SceneView& scene,
                                                  Mask useful,
                                                  LanesU medium_stack,
                                                  Lanes distance) {
    const Mask inside =
        useful & (dominant_medium(medium_stack) > LanesI(0)) & (distance < Lanes(farthest_lamp_m));
    if (none(inside)) return splat3(Lanes(1.0f));
    const Lanes path_length = select(inside, distance, Lanes(0.0f));
    return transmittance(scene, select(inside, medium_stack, LanesU(0U)), path_length);
}

/// The boundary of a medium as a path meets it.
struct Boundary {
    LanesU transmitted_stack;  ///< the medium stack on the transmitted side
    Lanes eta;                 ///< index of refraction there / here
    Mask hidden;               ///< inside a denser medium: nothing happens here
    Mask matched;  ///< between equal indices: light passes straight; where SceneView::thin_walls
    Mask passable = Mask(false);  ///< where matched or hidden, shadow rays pass it
};

/// Boundaries inside a denser medium that neither paths nor shadow rays notice.
OBSCURA_INLINE Mask is_passed_unseen(const Boundary& b) {
    return b.hidden & b.passable;
}

/// Sets how the boundary refracts light between the dominant media of its two sides.
///
/// In/Out  b: with `hidden`; lanes of `exists` change
OBSCURA_INLINE void set_refraction(
    const SceneView& scene, Mask exists, LanesI here, LanesI there, Boundary& b) {
    const Lanes eta = read_medium(scene, there).w / read_medium(scene, here).w;
    const Mask equal = exists & (abs(eta - Lanes(1.0f)) < Lanes(min_refraction));
    if (scene.thin_walls) b.matched = (equal & (!b.hidden)) | ((!exists) & b.matched);
    b.eta = select(exists, select(equal, Lanes(1.0f + min_refraction), eta), b.eta);
    b.eta = select(b.matched, Lanes(1.0f), b.eta);
}

/// In  medium: number of the medium that the surface bounds, 0: none; entering: seen from outside
OBSCURA_INLINE Boundary boundary_at(const SceneView& scene,
                                    LanesU medium_stack,
                                    LanesI medium,
                                    Mask entering) {
    Boundary b{medium_stack, Lanes(1.0f), Mask(false), Mask(false)};
    const Mask exists = medium > LanesI(0);
    if (scene.media == nullptr || none(exists)) return b;
    const LanesU inside = select(entering, enter_medium(medium_stack, medium), medium_stack);
    const LanesU outside = select(entering, medium_stack, leave_medium(medium_stack, medium));
    b.transmitted_stack = select(exists, select(entering, inside, outside), medium_stack);
    // A path that starts inside never entered this medium, but leaves it all the same.
    const LanesI within = max(dominant_medium(inside), medium);
    const LanesI around = dominant_medium(outside);
    b.hidden = exists & (within > medium);
    if (scene.passable_media) b.passable = exists & is_like_air(read_medium(scene, medium).w);
    set_refraction(
        scene, exists, select(entering, around, within), select(entering, within, around), b);
    return b;
}

/// SharedFaces of a group of paths.
struct SharedLanes {
    Mask exist;
    LanesU left, entered;
    Lanes reflected_clearance, transmitted_clearance;
};

OBSCURA_INLINE SharedLanes read_shared_faces(const SharedFaces* by_slot, LanesU slot) {
    static_assert((batch_size & (batch_size - 1)) == 0);
    const auto words = reinterpret_cast<const int32_t*>(by_slot);
    const LanesI in_range = as_int(slot & LanesU(uint32_t{batch_size - 1}));  // in idle lanes too
    const Four<LanesI> record =
        gather4<Lanes>(words, LanesI(in_range * LanesI(shared_faces_words)));
    return {record.x < LanesI(0),
            as_uint(record.x),
            as_uint(record.y),
            bits_float(record.z),
            bits_float(record.w)};
}

/// Replaces the boundary of the hit face by that of all coincident faces together: between the
/// dominant medium in front of all of them and the one behind all of them.
///
/// In/Out  b: of the hit face; lanes of shared.exist change
OBSCURA_INLINE void join_boundaries(const SceneView& scene,
                                    LanesU medium_stack,
                                    const SharedLanes& shared,
                                    Boundary& b) {
    const auto number = [](LanesU all, int shift) { return as_int((all >> shift) & LanesU(255U)); };
    LanesU stack = medium_stack;
    for (const int shift : {16, 8, 0}) {
        const LanesI medium = number(shared.left, shift);
        stack = select(medium > LanesI(0), leave_medium(stack, medium), stack);
    }
    for (const int shift : {16, 8, 0}) {
        const LanesI medium = number(shared.entered, shift);
        stack = select(medium > LanesI(0), enter_medium(stack, medium), stack);
    }
    // As above: a medium that the path leaves without having entered counts as around it.
    const LanesI here = max(dominant_medium(medium_stack), number(shared.left, 16U));
    const LanesI there = dominant_medium(stack);
    b.transmitted_stack = select(shared.exist, stack, b.transmitted_stack);
    b.hidden = (shared.exist & (here == there)) | ((!shared.exist) & b.hidden);
    b.passable = b.passable & (!shared.exist);  // shadow rays meet one face at a time
    set_refraction(scene, shared.exist, here, there, b);
}

/// Attenuates the paths by the absorption of the medium they came through. In scattering media
/// stage 2 has already done so.
OBSCURA_INLINE void absorb(const SceneView& scene, Mask exists, Lanes distance, PathLanes& path) {
    const LanesI medium = dominant_medium(path.medium_stack);
    Mask inside = exists & (medium > LanesI(0));
    if (none(inside)) return;
    if (scene.scatters) inside = inside & (!scatters(read_scattering(scene, medium)));
    const LanesU medium_stack = select(inside, path.medium_stack, LanesU(0U));
    path.throughput = path.throughput * transmittance(scene, medium_stack, distance);
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
