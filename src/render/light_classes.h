// render/light_classes.h - the light class of every light that light sampling may choose.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "film/light_groups.h"
#include "light/light_view.h"

#include <cstdint>
#include <vector>

namespace obscura {

/// By index of light sampling; see LightKind in stages/light_paths.h.
///
/// In   scene: after make_light_table; lights: the view of that table
std::vector<uint16_t> light_classes(const Scene& scene,
                                    const LightGroups& groups,
                                    const LightView& lights);

}  // namespace obscura
