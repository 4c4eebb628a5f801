// render/integrators.cpp - the closed list of integrators: their names, walks and channels.
// SPDX-License-Identifier: Apache-2.0
#include "render/integrators.h"

namespace obscura {

namespace {

constexpr bool is_in_order() {
    for (size_t i = 0; i < integrator_rows.size(); ++i) {
        if (integrator_rows[i].value != static_cast<Integrator>(i)) return false;
    }
    return true;
}
static_assert(is_in_order(), "row_of counts on it");

}  // namespace

std::vector<std::string> film_channels(Integrator integrator) {
    std::vector<std::string> names;
    for (const char* name : row_of(integrator).film) {
        if (name != nullptr) names.emplace_back(name);
    }
    return names;
}

int samples_taken(const RenderOptions& options) {
    switch (row_of(options.integrator).walk) {
        case WalkKind::path:
        case WalkKind::ao:
            return options.samples_per_pixel;
        case WalkKind::wireframe:
            return wireframe_rays;
        case WalkKind::raycast:
        case WalkKind::quantity:
            break;
    }
    return 1;
}

}  // namespace obscura
