// render/integrators.h - the closed list of integrators: names, kinds of transport, channels.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/render.h"
#include "stages/wavefront.h"

#include <array>
#include <string>
#include <vector>

namespace obscura {

struct IntegratorEntry {
    const char* name;  ///< on the command line
    Integrator value;
    WavefrontKind kind;
    Aov aov;                          ///< for WavefrontKind::aov and wireframe; else unused
    std::array<const char*, 4> film;  ///< channels; null: no more
};

/// In the order of the enumeration.
inline constexpr std::array<IntegratorEntry, 13> integrator_entries = {
    {{"path", Integrator::path, WavefrontKind::path, {}, {"R", "G", "B", "A"}},
     {"direct", Integrator::direct, WavefrontKind::path, {}, {"R", "G", "B", "A"}},
     {"raycast", Integrator::raycast, WavefrontKind::raycast, {}, {"R", "G", "B", "A"}},
     {"ao", Integrator::ao, WavefrontKind::ao, {}, {"R", "G", "B", "A"}},
     {"normal", Integrator::normal, WavefrontKind::aov, Aov::normal, {"N.X", "N.Y", "N.Z"}},
     {"facing", Integrator::facing, WavefrontKind::aov, Aov::facing, {"facing"}},
     {"depth", Integrator::depth, WavefrontKind::aov, Aov::depth, {"Z"}},
     {"distance", Integrator::distance, WavefrontKind::aov, Aov::distance, {"distance"}},
     {"uv", Integrator::uv, WavefrontKind::aov, Aov::uv, {"UV.U", "UV.V"}},
     {"albedo", Integrator::albedo, WavefrontKind::aov, Aov::albedo, {"R", "G", "B", "A"}},
     {"id", Integrator::id, WavefrontKind::aov, Aov::id, {"id.node", "id.material", "id.triangle"}},
     {"wireframe",
      Integrator::wireframe,
      WavefrontKind::wireframe,
      Aov::wireframe,
      {"R", "G", "B", "A"}},
     {"heat", Integrator::heat, WavefrontKind::aov, Aov::heat, {"heat"}}}};

constexpr const IntegratorEntry& entry_of(Integrator integrator) {
    return integrator_entries[static_cast<size_t>(integrator)];
}

/// True for AOVs: one ray through each pixel's centre, without light.
constexpr bool is_aov(Integrator integrator) {
    return entry_of(integrator).kind == WavefrontKind::aov;
}

/// Names of the channels of an integrator's film.
std::vector<std::string> film_channels(Integrator integrator);

/// Samples per pixel: some integrators ignore samples_per_pixel.
int samples_taken(const RenderOptions& options);

}  // namespace obscura
