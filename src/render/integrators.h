// render/integrators.h - the closed list of integrators: names, kinds of transport, channels.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/render.h"
#include "stages/wavefront.h"

#include <array>
#include <span>
#include <string>
#include <vector>

namespace obscura {

struct IntegratorEntry {
    const char* name;  ///< on the command line
    Integrator value;
    WavefrontKind kind;
    std::array<const char*, 4> film;  ///< channels; null: no more
    std::span<const Aov> aovs = {};   ///< for WavefrontKind::aov: what fills the channels
};

inline constexpr Aov normal_aovs[] = {Aov::normal};
inline constexpr Aov facing_aovs[] = {Aov::facing};
inline constexpr Aov depth_aovs[] = {Aov::depth};
inline constexpr Aov distance_aovs[] = {Aov::distance};
inline constexpr Aov uv_aovs[] = {Aov::uv};
inline constexpr Aov albedo_aovs[] = {Aov::base_color, Aov::opacity};
inline constexpr Aov id_aovs[] = {Aov::id_node, Aov::id_material, Aov::id_triangle};

/// In the order of the enumeration.
inline constexpr std::array<IntegratorEntry, 13> integrator_entries = {
    {{"path", Integrator::path, WavefrontKind::path, {"R", "G", "B", "A"}},
     {"direct", Integrator::direct, WavefrontKind::path, {"R", "G", "B", "A"}},
     {"raycast", Integrator::raycast, WavefrontKind::raycast, {"R", "G", "B", "A"}},
     {"ao", Integrator::ao, WavefrontKind::ao, {"R", "G", "B", "A"}},
     {"normal", Integrator::normal, WavefrontKind::aov, {"N.X", "N.Y", "N.Z"}, normal_aovs},
     {"facing", Integrator::facing, WavefrontKind::aov, {"facing"}, facing_aovs},
     {"depth", Integrator::depth, WavefrontKind::aov, {"Z"}, depth_aovs},
     {"distance", Integrator::distance, WavefrontKind::aov, {"distance"}, distance_aovs},
     {"uv", Integrator::uv, WavefrontKind::aov, {"UV.U", "UV.V"}, uv_aovs},
     {"albedo", Integrator::albedo, WavefrontKind::aov, {"R", "G", "B", "A"}, albedo_aovs},
     {"id", Integrator::id, WavefrontKind::aov, {"id.node", "id.material", "id.triangle"}, id_aovs},
     {"wireframe", Integrator::wireframe, WavefrontKind::wireframe, {"R", "G", "B", "A"}},
     {"heat", Integrator::heat, WavefrontKind::heat, {"heat"}}}};

constexpr const IntegratorEntry& entry_of(Integrator integrator) {
    return integrator_entries[static_cast<size_t>(integrator)];
}

/// True for AOVs and heat: one ray through each pixel's centre, without light.
constexpr bool is_aov(Integrator integrator) {
    const WavefrontKind kind = entry_of(integrator).kind;
    return kind == WavefrontKind::aov || kind == WavefrontKind::heat;
}

/// True for integrators that take samples_per_pixel samples.
constexpr bool takes_samples(Integrator integrator) {
    const WavefrontKind kind = entry_of(integrator).kind;
    return kind == WavefrontKind::path || kind == WavefrontKind::ao;
}

/// True for integrators beside whose image layers can stand.
constexpr bool has_layers(Integrator integrator) {
    return !is_aov(integrator) && integrator != Integrator::wireframe;
}

/// True for integrators that can render shadow catchers.
constexpr bool has_catchers(Integrator integrator) {
    return entry_of(integrator).kind == WavefrontKind::path;
}

/// Names of the channels of an integrator's film.
std::vector<std::string> film_channels(Integrator integrator);

/// Samples per pixel: some integrators ignore samples_per_pixel.
int samples_taken(const RenderOptions& options);

/// Fraction of a pixel's footprint that one sample's texture look-up covers: 1 / samples, with a
/// minimum so that look-ups still hit the caches.
/// Source  Pharr, Jakob, Humphreys, "Physically Based Rendering", 4th ed., 2023, section 10.1.1
float footprint_fraction(int samples);

/// BatchSettings::z_order_bits: with few samples of every pixel, neighbours share a sequence of
/// random numbers. -1: each has its own.
int z_order_bits(const RenderOptions& options);

/// From so many samples on, a sample does not depend on how many follow it: footprint_fraction and
/// z_order_bits are the same.
inline constexpr int min_samples_to_go_on = 64;

}  // namespace obscura
