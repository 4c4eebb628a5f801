// app/scene_choice.cpp - the option --scene, which several commands share.
// SPDX-License-Identifier: Apache-2.0
#include "app/scene_choice.h"

#include "app/numbers.h"

namespace obscura {

Result<LoadOptions> choose_scene(const std::optional<std::string>& text) {
    LoadOptions options;
    if (!text) return options;
    if (text->empty()) {
        return fail(ExitCode::usage,
                    "E-USAGE-CONFLICT",
                    "--scene",
                    "the name is empty; expected a scene's name or index");
    }
    if (!is_index(*text)) {
        options.scene_name = *text;
        return options;
    }
    const Result<int64_t> index = parse_integer(*text, "--scene", 0, INT32_MAX);
    if (!index) return fail(index.error());
    options.scene = static_cast<int>(*index);
    return options;
}

}  // namespace obscura
