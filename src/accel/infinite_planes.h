// accel/infinite_planes.h - infinite planes, which no BVH can hold: tested apart from it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/accel_impl.h"

namespace obscura {

/// Replaces a hit by that of the nearest infinite plane if that is nearer.
void meet_infinite_planes(const Accel::Impl& impl,
                          const QueryContext& context,
                          const RayColumns& rays,
                          const HitColumns& hits,
                          int index);

/// Appends the infinite planes that bound media in (0, tfar) of a ray.
void list_infinite_crossings(const Accel::Impl& impl,
                             const QueryContext& context,
                             const RayColumns& rays,
                             int index,
                             std::vector<Crossing>& out);

/// Appends the infinite planes in (0, tfar) of a ray.
void list_infinite_surfaces(const Accel::Impl& impl,
                            const QueryContext& context,
                            const RayColumns& rays,
                            int index,
                            std::vector<MetSurface>& out);

/// True when an infinite plane lies in (0, tfar) of a ray.
bool infinite_plane_occludes(const Accel::Impl& impl,
                             const QueryContext& context,
                             const RayColumns& rays,
                             int index);

}  // namespace obscura
