// render/integrators.h - the closed list of integrators: their names, walks and channels.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/render.h"
#include "stages/walk.h"

#include <array>
#include <string>
#include <vector>

namespace obscura {

struct IntegratorRow {
    const char* name;  ///< on the command line
    Integrator value;
    WalkKind walk;
    Quantity quantity;                ///< for WalkKind::quantity and wireframe; else not looked at
    std::array<const char*, 4> film;  ///< channels; null: no more
};

/// In the order of the enumeration.
inline constexpr std::array<IntegratorRow, 13> integrator_rows = {
    {{"path", Integrator::path, WalkKind::path, {}, {"R", "G", "B", "A"}},
     {"direct", Integrator::direct, WalkKind::path, {}, {"R", "G", "B", "A"}},
     {"raycast", Integrator::raycast, WalkKind::raycast, {}, {"R", "G", "B", "A"}},
     {"ao", Integrator::ao, WalkKind::ao, {}, {"R", "G", "B", "A"}},
     {"normal", Integrator::normal, WalkKind::quantity, Quantity::normal, {"N.X", "N.Y", "N.Z"}},
     {"facing", Integrator::facing, WalkKind::quantity, Quantity::facing, {"facing"}},
     {"depth", Integrator::depth, WalkKind::quantity, Quantity::depth, {"Z"}},
     {"distance", Integrator::distance, WalkKind::quantity, Quantity::distance, {"distance"}},
     {"uv", Integrator::uv, WalkKind::quantity, Quantity::uv, {"UV.U", "UV.V"}},
     {"albedo", Integrator::albedo, WalkKind::quantity, Quantity::albedo, {"R", "G", "B", "A"}},
     {"id",
      Integrator::id,
      WalkKind::quantity,
      Quantity::id,
      {"id.node", "id.material", "id.triangle"}},
     {"wireframe",
      Integrator::wireframe,
      WalkKind::wireframe,
      Quantity::wireframe,
      {"R", "G", "B", "A"}},
     {"heat", Integrator::heat, WalkKind::quantity, Quantity::heat, {"heat"}}}};

constexpr const IntegratorRow& row_of(Integrator integrator) {
    return integrator_rows[static_cast<size_t>(integrator)];
}

/// True when the integrator takes one ray through each pixel's centre, and writes what it finds.
constexpr bool is_quantity(Integrator integrator) {
    return row_of(integrator).walk == WalkKind::quantity;
}

/// What the film of an integrator holds.
std::vector<std::string> film_channels(Integrator integrator);

/// Samples that a pixel gets: not every integrator asks --spp.
int samples_taken(const RenderOptions& options);

}  // namespace obscura
