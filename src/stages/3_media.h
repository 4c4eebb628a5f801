// stages/3_media.h - the bodies that a ray travels in: which, what they absorb, where they end.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "stages/3_tables.h"

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

/// Extinction per metre, and the index of refraction in w.
OBSCURA_INLINE Four<Lanes> read_medium(const SceneView& scene, LanesI body) {
    return gather4<Lanes>(scene.media, LanesI(body * LanesI(medium_words)));
}

/// Share of the extinction that is scattering, and the mean cosine of a scattering in w.
OBSCURA_INLINE Four<Lanes> read_scattering(const SceneView& scene, LanesI body) {
    return gather4<Lanes>(scene.media, LanesI(body * LanesI(medium_words) + LanesI(4)));
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
};

/// In  body: number of the body that the surface bounds, 0: none; entering: seen from outside
OBSCURA_INLINE Boundary boundary_at(const SceneView& scene,
                                    LanesU bodies,
                                    LanesI body,
                                    Mask entering) {
    Boundary b{bodies, Lanes(1.0f), Mask(false)};
    const Mask exists = body > LanesI(0);
    if (scene.media == nullptr || none(exists)) return b;
    const LanesU inside = select(entering, enter_body(bodies, body), bodies);
    const LanesU outside = select(entering, bodies, leave_body(bodies, body));
    b.beyond = select(exists, select(entering, inside, outside), bodies);
    // A path that starts inside has not entered: what it leaves is this body all the same.
    const LanesI within = max(filling_body(inside), body);
    const Lanes ior_inside = read_medium(scene, within).w;
    const Lanes ior_outside = read_medium(scene, filling_body(outside)).w;
    const Lanes eta = select(entering, ior_inside / ior_outside, ior_outside / ior_inside);
    // Equal media do not bend; the formulas need some difference, which bends by 1e-3 at most.
    const Lanes apart = select(abs(eta - Lanes(1.0f)) < Lanes(1e-3f), Lanes(1.001f), eta);
    b.eta = select(exists, apart, b.eta);
    b.hidden = exists & (within > body);
    return b;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
