// tests/cli/sliding_box.h - a scene in which something moves.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/cli.h"
#include <nlohmann/json.hpp>

namespace obscura {

/// The box slides from x = -1 to x = 1 in two seconds, seen by the camera "Front".
inline std::string sliding_box() {
    using nlohmann::json;
    json tree = json::parse(gltf_text(box_scene()));
    const std::vector<float> numbers = {0, 2, -1, 0, 0, 1, 0, 0};
    const std::string bytes(reinterpret_cast<const char*>(numbers.data()), numbers.size() * 4);
    tree["buffers"].push_back({{"byteLength", bytes.size()},
                               {"uri", "data:application/octet-stream;base64," + base64(bytes)}});
    tree["bufferViews"].push_back({{"buffer", 1}, {"byteLength", 8}});
    tree["bufferViews"].push_back({{"buffer", 1}, {"byteOffset", 8}, {"byteLength", 24}});
    tree["accessors"].push_back({{"bufferView", 2},
                                 {"componentType", 5126},
                                 {"type", "SCALAR"},
                                 {"count", 2},
                                 {"min", {0}},
                                 {"max", {2}}});
    tree["accessors"].push_back(
        {{"bufferView", 3}, {"componentType", 5126}, {"type", "VEC3"}, {"count", 2}});
    tree["animations"] = json::array(
        {{{"name", "Slide"},
          {"samplers", json::array({{{"input", 2}, {"output", 3}}})},
          {"channels",
           json::array({{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}})}}});
    return tree.dump();
}

}  // namespace obscura
