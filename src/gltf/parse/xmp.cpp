// gltf/parse/xmp.cpp - KHR_xmp_json_ld and KHR_xmp: what an asset says about itself.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/xmp.h"

#include "base/json/json.h"

namespace obscura::gltf {

std::string read_xmp(const JsonReader& root, const nlohmann::json& tree) {
    const JsonReader asset = root.child("asset");
    for (const char* name : {"KHR_xmp_json_ld", "KHR_xmp"}) {
        if (!asset.has_extension(name)) continue;
        const size_t count = root.extension(name).count("packets");
        const int packet = asset.extension(name).index("packet", count, "packet");
        if (packet < 0) return {};
        const nlohmann::json& extension = tree["extensions"][name];
        nlohmann::json out = extension["packets"][static_cast<size_t>(packet)];
        // The older extension keeps the vocabulary beside the packets.
        if (out.is_object() && extension.contains("@context") && !out.contains("@context")) {
            out["@context"] = extension["@context"];
        }
        return escape_json_controls(out.dump());
    }
    return {};
}

}  // namespace obscura::gltf
