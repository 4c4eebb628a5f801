// gltf/parse/document_lights.cpp - reads EXT_lights_ies and EXT_lights_image_based.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/document_lights.h"

#include "gltf/parse/light_camera_entries.h"
#include "gltf/parse/trs.h"

#include <algorithm>

namespace obscura::gltf {

namespace {

constexpr const char* ies_name = "EXT_lights_ies";
constexpr const char* image_based_name = "EXT_lights_image_based";
constexpr const char* ies_mime = "application/x-ies-lm-63";

GltfEnvironment read_environment(DocumentReading& reading, const ValueReader& light, size_t index) {
    GltfEnvironment out;
    out.name = light.text("name");
    if (out.name.empty()) out.name = "image-based light " + std::to_string(index);
    for (const NumberEntry<GltfEnvironment>& entry : environment_entries)
        clamped_numbers(reading, light, entry.place, entry.numbers(out), entry.limits);
    light.numbers("rotation", out.rotation);
    if (!normalize_quaternion(out.rotation)) {
        light.fault("rotation", "E-LIGHT-ROTATION", "the quaternion has no length");
    }
    out.side = light.size("specularImageSize", 0);
    light.require("specularImages");
    const auto levels =
        light.index_lists("specularImages", reading.document.images.size(), "image");
    if (reading.failed()) return out;
    if (levels.empty() || levels.front().size() != out.images.size()) {
        light.fault("specularImages",
                    "E-LIGHT-FACES",
                    "the first level must have the six faces +X, -X, +Y, -Y, +Z and -Z of a cube");
        return out;
    }
    std::copy(levels.front().begin(), levels.front().end(), out.images.begin());
    return out;
}

}  // namespace

void read_light_profiles(DocumentReading& reading) {
    if (!reading.root().has_extension(ies_name)) return;
    const size_t view_count = reading.document.views.size();
    const auto read = [&](const ValueReader& light, size_t index) {
        GltfLightProfile out;
        out.name = light.text("name");
        if (out.name.empty()) out.name = "light profile " + std::to_string(index);
        out.view = light.index("bufferView", view_count, "buffer view");
        if (light.has("uri")) out.uri = light.text("uri");
        if (out.uri.has_value() == light.has("bufferView")) {
            light.fault(
                "", "E-LIGHT-PROFILE", "a light profile must have either a uri or a bufferView");
        }
        const std::string mime = light.text("mimeType", ies_mime);
        if (mime != ies_mime) {
            reading.log.warn(reading.document.at(light.pointer()),
                             "the media type is \"" + mime + "\", not " + ies_mime +
                                 "; the data are read as that");
        }
        reading.document.profiles.push_back(std::move(out));
    };
    reading.root().extension(ies_name).each("lights", read);
}

GltfProfileUse read_node_profile(DocumentReading& reading, const ModelElement& node) {
    GltfProfileUse out;
    if (!node.has_extension(ies_name)) return out;
    const ValueReader use = node.extension(ies_name);
    use.require("light");
    out.profile = use.index("light", reading.document.profiles.size(), "light profile");
    for (const NumberEntry<GltfProfileUse>& entry : profile_entries)
        clamped_numbers(reading, use, entry.place, entry.numbers(out), entry.limits);
    return out;
}

void read_environments(DocumentReading& reading) {
    if (!reading.root().has_extension(image_based_name)) return;
    reading.root()
        .extension(image_based_name)
        .each("lights", [&](const ValueReader& light, size_t index) {
            reading.document.environments.push_back(read_environment(reading, light, index));
        });
}

}  // namespace obscura::gltf
