// surface/scatter_event.h - a scattering as light path expressions know it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace obscura {

/// Light scattered at a surface or in a medium, as a path meets it from the camera on.
struct ScatterEvent {
    char type;              ///< R reflection, T transmission, V volume
    char mode;              ///< D diffuse, G glossy, S singular
    std::string_view lobe;  ///< its label: "coat"
};

}  // namespace obscura
