// accel/endless_planes.h - planes without end, which no BVH can hold, beside what the BVH found.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "accel/accel_impl.h"

namespace obscura {

/// Puts the nearest plane without end in the place of a row's hit where it is nearer.
void meet_endless_planes(const Accel::Impl& impl,
                         const QueryContext& context,
                         const RayColumns& rays,
                         const HitColumns& hits,
                         int row);

/// Appends the planes without end that bound bodies in (0, tfar) of the row's ray.
void list_endless_crossings(const Accel::Impl& impl,
                            const QueryContext& context,
                            const RayColumns& rays,
                            int row,
                            std::vector<Crossing>& out);

/// True when a plane without end lies in (0, tfar) of the row's ray.
bool endless_plane_hides(const Accel::Impl& impl,
                         const QueryContext& context,
                         const RayColumns& rays,
                         int row);

}  // namespace obscura
