// render/integrators.cpp - the closed list of integrators: names, kinds of transport, channels.
// SPDX-License-Identifier: Apache-2.0
#include "render/integrators.h"

#include <algorithm>

namespace obscura {

namespace {

constexpr bool is_in_order() {
    for (size_t i = 0; i < integrator_entries.size(); ++i) {
        if (integrator_entries[i].value != static_cast<Integrator>(i)) return false;
    }
    return true;
}
static_assert(is_in_order(), "entry_of counts on it");

}  // namespace

std::vector<std::string> film_channels(Integrator integrator) {
    std::vector<std::string> names;
    for (const char* name : entry_of(integrator).film) {
        if (name != nullptr) names.emplace_back(name);
    }
    return names;
}

int samples_taken(const RenderOptions& options) {
    switch (entry_of(options.integrator).kind) {
        case WavefrontKind::path:
        case WavefrontKind::ao:
            return options.samples_per_pixel;
        case WavefrontKind::wireframe:
            return wireframe_rays;
        case WavefrontKind::raycast:
        case WavefrontKind::aov:
        case WavefrontKind::heat:
            break;
    }
    return 1;
}

float footprint_fraction(int samples) {
    return 1.0f / static_cast<float>(std::min(samples, min_samples_of_finest_footprint));
}

}  // namespace obscura
