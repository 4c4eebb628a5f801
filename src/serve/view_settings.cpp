// serve/view_settings.cpp - what a client asks a picture for.
// SPDX-License-Identifier: Apache-2.0
#include "serve/view_settings.h"

namespace obscura::serve {

bool is_of_display(const std::string& option, const Options& all) {
    // Adaptive sampling looks at the picture as it is exposed.
    if (option == "exposure") return !all.contains("noise-target");
    return option == "view" || option == "display";
}

std::string rendering_of(const Options& options) {
    Options samples = Options::object();
    for (const auto& [name, value] : options.items()) {
        if (!is_of_display(name, options)) samples[name] = value;
    }
    return samples.dump();
}

}  // namespace obscura::serve
