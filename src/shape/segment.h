// shape/segment.h - one curve segment: a capsule in any direction, with its local frame.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shape/capsule.h"

namespace obscura {
inline namespace OBSCURA_ISA {

/// The hull of two spheres.
template <typename F>
struct Segment {
    Vec3<F> from, to;
    F radius_from, radius_to;
};

/// The segment as a capsule around the origin, from bottom to top, with the transform to it. Points
/// are translated before they are rotated, so that numbers stay as small as the capsule.
template <typename F>
struct SegmentFrame {
    Vec3<F> centre;
    Frame<F> axes;  ///< the normal goes from `from` to `to`
    Capsule<F> capsule;
};

/// In   segment: its ends differ. A sphere that would contain the other one is made smaller.
template <typename F>
OBSCURA_INLINE SegmentFrame<F> frame_of(const Segment<F>& segment) {
    const Vec3<F> way = segment.to - segment.from;
    const F length_m = max(length(way), F(1e-30f));
    const F most = length_m * F(0.99f);  // of the radii's difference
    const F bottom = min(segment.radius_from, segment.radius_to + most);
    const F top = min(segment.radius_to, segment.radius_from + most);
    const Vec3<F> origin{F(0.0f), F(0.0f), F(0.0f)};
    return {segment.from + way * F(0.5f),
            frame_around(way * (F(1.0f) / length_m)),
            {origin, length_m * F(0.5f), bottom, top}};
}

/// Directions into the capsule's space and back.
template <typename F>
OBSCURA_INLINE Vec3<F> into_frame(const SegmentFrame<F>& frame, const Vec3<F>& v) {
    return {dot(v, frame.axes.tangent), dot(v, frame.axes.normal), dot(v, -frame.axes.bitangent)};
}
template <typename F>
OBSCURA_INLINE Vec3<F> out_of_frame(const SegmentFrame<F>& frame, const Vec3<F>& v) {
    return frame.axes.tangent * v.x + frame.axes.normal * v.y - frame.axes.bitangent * v.z;
}

template <typename F>
OBSCURA_INLINE Roots<F> intersect_segment(const SegmentFrame<F>& frame, const ShapeRay<F>& ray) {
    const NearRay<F> near = bring_near(ray, frame.centre);
    const ShapeRay<F> own{into_frame(frame, near.origin), into_frame(frame, near.direction)};
    return on_ray(near, intersect_capsule(frame.capsule, own));
}

/// Interpolation weight of `to`, in [0, 1], at a height in the capsule's space.
template <typename F>
OBSCURA_INLINE F fraction_along(const SegmentFrame<F>& frame, const F& height) {
    const F half = frame.capsule.half_height;
    return min(max((height + half) / (half + half), F(0.0f)), F(1.0f));
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
