// film/light_components.cpp - the named parts of the light, as light path expressions.
// SPDX-License-Identifier: Apache-2.0
#include "film/light_components.h"

#include <array>

namespace obscura {

namespace {

constexpr std::array components = {
    LightComponent{
        "diffuse_direct", "C<R.'diffuse'><TS'straight'>*[LOB]", "lights, reflected diffusely"},
    LightComponent{"diffuse_indirect",
                   "C<R.'diffuse'><TS'straight'>*[^<TS'straight'>LOB].*[LOB]",
                   "lit surfaces, reflected diffusely"},
    LightComponent{"specular_direct",
                   "C<R.'specular'><TS'straight'>*[LOB]",
                   "lights in metal and gloss, smooth or rough"},
    LightComponent{"specular_indirect",
                   "C<R.'specular'><TS'straight'>*[^<TS'straight'>LOB].*[LOB]",
                   "lit surfaces in metal and gloss"},
    LightComponent{"coat_direct", "C<R.'coat'><TS'straight'>*[LOB]", "lights in the clear coat"},
    LightComponent{"coat_indirect",
                   "C<R.'coat'><TS'straight'>*[^<TS'straight'>LOB].*[LOB]",
                   "lit surfaces in the clear coat"},
    LightComponent{
        "sheen_direct", "C<R.'sheen'><TS'straight'>*[LOB]", "lights in the sheen of cloth"},
    LightComponent{"sheen_indirect",
                   "C<R.'sheen'><TS'straight'>*[^<TS'straight'>LOB].*[LOB]",
                   "lit surfaces in the sheen"},
    LightComponent{
        "transmission_direct", "C<T.>+[LOB]", "lights and the environment, through surfaces alone"},
    LightComponent{
        "transmission_indirect", "C<T.>+R.*[LOB]", "lit surfaces behind what lets light through"},
    LightComponent{
        "subsurface", "C<T.>+V.*[LOB]", "light scattered within bodies that the camera sees"},
    LightComponent{"volume", "CV.*[LOB]", "light scattered in the medium around the camera"},
    LightComponent{"emission", "CO", "what the camera sees emit; unlit surfaces"},
    LightComponent{
        "background", "C[LB]", "the environment and the background as the camera sees them"}};

}  // namespace

std::span<const LightComponent> light_components() {
    return components;
}

}  // namespace obscura
