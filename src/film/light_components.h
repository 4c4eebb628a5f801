// film/light_components.h - the named parts of the light, as light path expressions.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

namespace obscura {

/// A part of the light with a name, for --aov.
struct LightComponent {
    const char* name;
    const char* expression;
    const char* help;
};

/// All light, which light groups cut by lights alone.
inline constexpr const char* all_light = "C.*[LOB]";

/// A partition: every path belongs to one of them, by its first scattering. Direct light comes from
/// a light to the surface that the camera sees, maybe straight through smooth thin walls.
std::span<const LightComponent> light_components();

}  // namespace obscura
