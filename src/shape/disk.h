// shape/disk.h - a disk, or a ring, with the normal +Y.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shape/surface_point.h"

namespace obscura {
inline namespace OBSCURA_ISA {

template <typename F>
struct Disk {
    Vec3<F> centre;
    F radius;
    F hole;  ///< inner radius, 0: none
};

template <typename F>
OBSCURA_INLINE Roots<F> intersect_disk(const Disk<F>& disk, const ShapeRay<F>& ray) {
    const NearRay<F> near = bring_near(ray, disk.centre);
    const F t = -near.origin.y / near.direction.y;
    const Vec3<F> p = point_at(near, t);
    const F squared = p.x * p.x + p.z * p.z;
    const MaskOf<F> met = (abs(t) < F(no_limit)) & (squared <= disk.radius * disk.radius) &
                          (squared >= disk.hole * disk.hole);
    return on_ray<F>(near, {{t, t}, {met, met}});
}

/// The disk is cut out of a square texture: u grows along +X, v along +Z.
template <typename F>
OBSCURA_INLINE SurfacePoint<F> surface_of_disk(const Disk<F>& disk, const Vec3<F>& near) {
    const F zero(0.0f);
    const F width = disk.radius + disk.radius;
    SurfacePoint<F> out;
    out.position = {near.x, zero, near.z};
    out.normal = {zero, F(1.0f), zero};
    out.dpdu = {width, zero, zero};
    out.dpdv = {zero, zero, width};
    out.uv = {near.x / width + F(0.5f), near.z / width + F(0.5f)};
    out.error = zero;
    return out;
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
