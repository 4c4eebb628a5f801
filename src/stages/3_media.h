// stages/3_media.h - the bodies that a ray travels in: which, what they absorb, where they end.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/3_tables.h"
#include "surface/fresnel.h"

namespace obscura {
inline namespace OBSCURA_ISA {

// PathRows::bodies holds, from the upper end:
//   bits 31-24  1 once the path has been given one wavelength (dispersion)
//   bits 23-0   the numbers of up to three bodies that overlap here, the greatest first; 0: none
// The greatest number fills the place (scene/media.h). Of more than three, the least is forgotten.

inline constexpr uint32_t one_wavelength = 1U << 24;

/// Number of the body that fills the place.
OBSCURA_INLINE LanesI filling_body(LanesU bodies) {
    return as_int((bodies >> 16) & LanesU(255U));
}

OBSCURA_INLINE LanesU join_bodies(LanesU bodies, LanesI first, LanesI second, LanesI third) {
    return (bodies & LanesU(~0xFFFFFFU)) | as_uint(first) << 16 | as_uint(second) << 8 |
           as_uint(third);
}

/// The bodies after one more is entered.
OBSCURA_INLINE LanesU enter_body(LanesU bodies, LanesI body) {
    const LanesI first = filling_body(bodies);
    const LanesI second = as_int((bodies >> 8) & LanesU(255U));
    const LanesI third = as_int(bodies & LanesU(255U));
    const LanesI lower = min(first, body);
    return join_bodies(
        bodies, max(first, body), max(second, lower), max(third, min(second, lower)));
}

/// The bodies after one is left; one that was never entered changes nothing.
OBSCURA_INLINE LanesU leave_body(LanesU bodies, LanesI body) {
    const LanesI first = filling_body(bodies);
    const LanesI second = as_int((bodies >> 8) & LanesU(255U));
    const LanesI third = as_int(bodies & LanesU(255U));
    const Mask is_first = first == body;
    const Mask is_second = is_first | (second == body);
    const Mask is_third = is_second | (third == body);
    return join_bodies(bodies,
                       select(is_first, second, first),
                       select(is_second, third, second),
                       select(is_third, LanesI(0), third));
}

/// Four words of a medium, from a member on. Always gathered: lanes seldom travel in one medium.
template <auto member>
OBSCURA_INLINE Four<Lanes> gather_medium(const SceneView& scene, LanesI body) {
    return gather4<Lanes>(reinterpret_cast<const float*>(scene.media) + word_of<member>,
                          LanesI(body * LanesI(words_per_row<Medium>)));
}

/// Extinction per metre, and the index of refraction in w.
OBSCURA_INLINE Four<Lanes> read_medium(const SceneView& scene, LanesI body) {
    static_assert(word_of<&Medium::ior> == word_of<&Medium::extinction> + 3);
    return gather_medium<&Medium::extinction>(scene, body);
}

/// Share of the extinction that is scattering, and the mean cosine of a scattering in w.
OBSCURA_INLINE Four<Lanes> read_scattering(const SceneView& scene, LanesI body) {
    static_assert(word_of<&Medium::anisotropy> == word_of<&Medium::albedo> + 3);
    return gather_medium<&Medium::albedo>(scene, body);
}

OBSCURA_INLINE Mask scatters(const Four<Lanes>& scattering) {
    return max(scattering.x, max(scattering.y, scattering.z)) > Lanes(0.0f);
}

/// What is left of light after a way through what fills the place.
/// Source  Beer and Lambert's law
OBSCURA_INLINE Vec3<Lanes> transmittance(const SceneView& scene, LanesU bodies, Lanes distance_m) {
    const Four<Lanes> medium = read_medium(scene, filling_body(bodies));
    return {exp(-(medium.x * distance_m)),
            exp(-(medium.y * distance_m)),
            exp(-(medium.z * distance_m))};
}

/// The boundary of a body as a path meets it.
struct Boundary {
    LanesU beyond;  ///< the bodies on the other side
    Lanes eta;      ///< index of refraction there / here
    Mask hidden;    ///< inside a denser body: nothing happens here
    Mask matched;   ///< between equal indices: light passes straight; where SceneView::thin_walls
};

/// What the boundary does to light between the bodies that fill the places here and there.
///
/// In/Out  b: with `hidden`; lanes of `exists` change
OBSCURA_INLINE void bend(
    const SceneView& scene, Mask exists, LanesI here, LanesI there, Boundary& b) {
    const Lanes eta = read_medium(scene, there).w / read_medium(scene, here).w;
    const Mask equal = exists & (abs(eta - Lanes(1.0f)) < Lanes(least_refraction));
    if (scene.thin_walls) b.matched = (equal & (!b.hidden)) | ((!exists) & b.matched);
    b.eta = select(exists, select(equal, Lanes(1.0f + least_refraction), eta), b.eta);
    b.eta = select(b.matched, Lanes(1.0f), b.eta);
}

/// In  body: number of the body that the surface bounds, 0: none; entering: seen from outside
OBSCURA_INLINE Boundary boundary_at(const SceneView& scene,
                                    LanesU bodies,
                                    LanesI body,
                                    Mask entering) {
    Boundary b{bodies, Lanes(1.0f), Mask(false), Mask(false)};
    const Mask exists = body > LanesI(0);
    if (scene.media == nullptr || none(exists)) return b;
    const LanesU inside = select(entering, enter_body(bodies, body), bodies);
    const LanesU outside = select(entering, bodies, leave_body(bodies, body));
    b.beyond = select(exists, select(entering, inside, outside), bodies);
    // A path that starts inside has not entered: what it leaves is this body all the same.
    const LanesI within = max(filling_body(inside), body);
    const LanesI around = filling_body(outside);
    b.hidden = exists & (within > body);
    bend(scene, exists, select(entering, around, within), select(entering, within, around), b);
    return b;
}

/// SharedFaces of a group of paths.
struct SharedLanes {
    Mask exist;
    LanesU left, entered;
    Lanes before, beyond;
};

OBSCURA_INLINE SharedLanes read_shared_faces(const SharedFaces* by_slot, LanesU slot) {
    static_assert((batch_rows & (batch_rows - 1)) == 0);
    const auto words = reinterpret_cast<const int32_t*>(by_slot);
    const LanesI in_range = as_int(slot & LanesU(uint32_t{batch_rows - 1}));  // in idle lanes too
    const Four<LanesI> row = gather4<Lanes>(words, LanesI(in_range * LanesI(shared_faces_words)));
    return {
        row.x < LanesI(0), as_uint(row.x), as_uint(row.y), bits_float(row.z), bits_float(row.w)};
}

/// The boundary of all bodies whose faces lie together at a hit, in place of the one that was hit:
/// from the body that fills the place before them to the one that does behind them.
///
/// In/Out  b: of the hit face; lanes of shared.exist change
OBSCURA_INLINE void join_boundaries(const SceneView& scene,
                                    LanesU bodies,
                                    const SharedLanes& shared,
                                    Boundary& b) {
    const auto number = [](LanesU all, int shift) { return as_int((all >> shift) & LanesU(255U)); };
    LanesU beyond = bodies;
    for (const int shift : {16, 8, 0}) {
        const LanesI body = number(shared.left, shift);
        beyond = select(body > LanesI(0), leave_body(beyond, body), beyond);
    }
    for (const int shift : {16, 8, 0}) {
        const LanesI body = number(shared.entered, shift);
        beyond = select(body > LanesI(0), enter_body(beyond, body), beyond);
    }
    // As above: what a path leaves without having entered it is around it all the same.
    const LanesI here = max(filling_body(bodies), number(shared.left, 16U));
    const LanesI there = filling_body(beyond);
    b.beyond = select(shared.exist, beyond, b.beyond);
    b.hidden = (shared.exist & (here == there)) | ((!shared.exist) & b.hidden);
    bend(scene, shared.exist, here, there, b);
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
