// render/integrators.cpp - the closed list of integrators: names, kinds of transport, channels.
// SPDX-License-Identifier: Apache-2.0
#include "render/integrators.h"

#include <algorithm>
#include <bit>

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
    return 1.0f / static_cast<float>(std::min(samples, min_samples_to_go_on));
}

// Stratifying neighbours together helps most with few samples. From min_samples_to_go_on on, more
// of them may follow; in adaptive sampling, pixels take different numbers. There the shared
// sequence would have no room, or gaps.
int z_order_bits(const RenderOptions& options) {
    const int samples = samples_taken(options);
    if (options.adaptive || samples >= min_samples_to_go_on) return -1;
    return static_cast<int>(std::bit_width(static_cast<unsigned>(samples - 1)));
}

}  // namespace obscura
