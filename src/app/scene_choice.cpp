// app/scene_choice.cpp - the options --scene and --variant, which several commands share.
// SPDX-License-Identifier: Apache-2.0
#include "app/scene_choice.h"

#include "app/numbers.h"

namespace obscura::app {

Result<gltf::LoadOptions> choose_scene(const std::optional<std::string>& scene,
                                       const std::optional<std::string>& variant) {
    gltf::LoadOptions options;
    if (variant && variant->empty()) {
        return fail(ExitCode::usage,
                    "E-USAGE-CONFLICT",
                    "--variant",
                    "the name is empty; expected a variant's name");
    }
    options.variant = variant.value_or("");
    if (!scene) return options;
    if (scene->empty()) {
        return fail(ExitCode::usage,
                    "E-USAGE-CONFLICT",
                    "--scene",
                    "the name is empty; expected a scene's name or index");
    }
    if (!is_index(*scene)) {
        options.scene_name = *scene;
        return options;
    }
    const Result<int64_t> index = parse_integer(*scene, "--scene", 0, INT32_MAX);
    if (!index) return fail(index.error());
    options.scene = static_cast<int>(*index);
    return options;
}

}  // namespace obscura::app
