// tests/gltf/camera_extension_test.cpp - OBSCURA_camera: the reader against the schema.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/camera_extension.h"

#include "gltf/values.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace obscura::gltf {
namespace {

using nlohmann::json;

json read_json(const std::filesystem::path& file) {
    std::ifstream stream(file);
    return json::parse(stream);
}

/// Part of JSON Schema: type, enum, limits, items, properties, not required.
bool matches(const json& value, const json& schema) {
    const std::string type = schema.value("type", "");
    const bool typed = type.empty() || (type == "object" && value.is_object()) ||
                       (type == "array" && value.is_array()) ||
                       (type == "integer" && value.is_number_integer()) ||
                       (type == "number" && value.is_number());
    if (!typed) return false;
    if (schema.contains("enum")) {
        const json& names = schema["enum"];
        return std::find(names.begin(), names.end(), value) != names.end();
    }
    if (value.is_number()) {
        const double number = value.get<double>();
        return number >= schema.value("minimum", -1e300) &&
               number <= schema.value("maximum", 1e300);
    }
    if (value.is_array()) {
        return value.size() >= schema.value("minItems", 0U) &&
               value.size() <= schema.value("maxItems", 1000U) &&
               std::all_of(value.begin(), value.end(), [&](const json& element) {
                   return matches(element, schema["items"]);
               });
    }
    if (schema.contains("not")) {
        const json& keys = schema["not"]["required"];
        const auto has = [&](const json& key) { return value.contains(key.get<std::string>()); };
        if (std::all_of(keys.begin(), keys.end(), has)) return false;
    }
    const json properties = schema.value("properties", json::object());
    return std::all_of(value.items().begin(), value.items().end(), [&](const auto& item) {
        const auto known = properties.find(item.key());
        return known == properties.end() ? schema.value("additionalProperties", true)
                                         : matches(item.value(), *known);
    });
}

json schema() {
    return read_json(OBSCURA_SOURCE_DIR "/docs/extensions/OBSCURA_camera/schema.json");
}

/// True when the reader finds no fault.
bool reads(const json& extension) {
    JsonFault fault;
    fault.file = "test";
    read_camera_extension(ValueReader(test::value_of(extension), "", fault));
    return !fault.error;
}

TEST(CameraExtension, TheExampleAssetsFollowTheSchema) {
    const json rules = schema();
    const json asset = read_json(OBSCURA_SOURCE_DIR "/assets/cameras/cameras.gltf");
    int count = 0;
    for (const json& camera : asset.at("cameras")) {
        if (!camera.contains("extensions")) continue;
        const json& extension = camera.at("extensions").at("OBSCURA_camera");
        EXPECT_TRUE(matches(extension, rules)) << extension;
        EXPECT_TRUE(reads(extension)) << extension;
        ++count;
    }
    EXPECT_GE(count, 10);
}

/// The reader refuses exactly what the schema refuses.
TEST(CameraExtension, ReaderAndSchemaAgree) {
    const json rules = schema();
    const std::vector<std::pair<const char*, bool>> cases = {
        {R"({})", true},
        {R"({"extras": {"anything": 1}})", true},
        {R"({"model": "pinhole", "shift": [0.5, -0.5], "near": 0})", true},
        {R"({"model": "orthographic"})", true},
        {R"({"lens": {"radius": 0, "focusDistance": 3}})", true},
        {R"({"lens": {"fstop": 2, "blades": 3, "bladeRotation": -1}})", true},
        {R"({"fisheye": {"projection": "opencv", "coefficients": [0.1, 0, 0, 0]}})", true},
        {R"({"exposure": {"ev100": 12}})", true},
        {R"({"shift": [0.5]})", false},
        {R"({"shift": [0.5, 1000]})", false},
        {R"({"sensor": [0, 0.024]})", false},
        {R"({"near": -1})", false},
        {R"({"model": "thin lens"})", false},
        {R"({"lens": {"fstop": 2, "radius": 1}})", false},
        {R"({"lens": {"fstop": 2, "blades": 65}})", false},
        {R"({"lens": {"fstop": 2, "anamorphic": 0}})", false},
        {R"({"lens": []})", false},
        {R"({"fisheye": {"fov": 0}})", false},
        {R"({"fisheye": {"fit": "square"}})", false},
        {R"({"environment": {"projection": "cross"}})", false},
        {R"({"environment": {"stereo": -1}})", false},
        {R"({"exposure": {"shutter": 0, "iso": 100}})", false},
        {R"({"focal": 1})", false}};
    for (const auto& [text, good] : cases) {
        EXPECT_EQ(matches(json::parse(text), rules), good) << text;
        EXPECT_EQ(reads(json::parse(text)), good) << text;
    }
}

TEST(CameraExtension, ModelsAreMeantByWhatIsThere) {
    const auto model = [](const char* text) {
        JsonFault fault;
        const json extension = json::parse(text);
        return read_camera_extension(ValueReader(test::value_of(extension), "", fault)).model;
    };
    EXPECT_EQ(model("{}"), std::nullopt);
    EXPECT_EQ(model(R"({"lens": {"fstop": 2}})"), CameraModel::thin_lens);
    EXPECT_EQ(model(R"({"lens": {"fstop": 2}, "exposure": {"shutter": 1}})"), std::nullopt);
    EXPECT_EQ(model(R"({"fisheye": {"fov": 3}})"), CameraModel::fisheye);
    EXPECT_EQ(model(R"({"environment": {"stereo": 0.1}})"), CameraModel::environment);
    EXPECT_EQ(model(R"({"model": "pinhole", "lens": {"fstop": 2}})"), CameraModel::pinhole);
}

}  // namespace
}  // namespace obscura::gltf
