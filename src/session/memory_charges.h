// session/memory_charges.h - charges what a session's images take to the process's memory budget.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/memory_budget.h"
#include "render/prepared_scene.h"
#include "session/render_request.h"

#include <vector>

namespace obscura {

/// What one session has taken; the BVH, environments and the asset's own bytes keep their charges
/// themselves.
struct MemoryCharges {
    std::vector<MemoryCharge> textures;  ///< shared with the asset, which may go before its texels
    MemoryCharge geometry;
    MemoryCharge film;
};

/// Charges a scene's tables, but not its texels. The loader has asked before whether they fit.
///
/// Errors  33 E-MEM; so all
Result<void> charge_geometry(const Scene& scene, MemoryCharges& charges);

/// Charges the film with its layers, what its samples are gathered in, and what is made of it when
/// it is denoised and written. To be called before there is a film.
///
/// In      options: with the layers of the image
/// Errors  33 E-MEM; those of make_light_groups
Result<void> charge_film(const Scene& scene,
                         const RenderRequest& request,
                         const RenderOptions& options,
                         MemoryCharges& charges);

}  // namespace obscura
