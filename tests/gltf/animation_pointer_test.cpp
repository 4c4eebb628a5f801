// tests/gltf/animation_pointer_test.cpp - JSON pointers of KHR_animation_pointer.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/animation_pointer.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace obscura {
namespace {

using nlohmann::json;

json tree() {
    return json::parse(R"({
        "nodes": [{}, {"mesh": 0}], "meshes": [{}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 1},
                     "extensions": {"OBSCURA_camera": {"lens": {"fstop": 2, "blades": 5}}}}],
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "spot", "spot": {}}, {}]}},
        "materials": [{"normalTexture": {"index": 0},
                       "occlusionTexture": {"index": 0},
                       "extensions": {"KHR_materials_sheen": {"sheenColorTexture": {"index": 1}}}}]
    })");
}

struct Good {
    const char* pointer;
    ChannelPath path;
    int target;
    size_t width;
};

TEST(AnimationPointer, NamesEveryKindOfProperty) {
    const Good rows[] = {
        {"/nodes/1/translation", ChannelPath::translation, 1, 3},
        {"/nodes/0/rotation", ChannelPath::rotation, 0, 4},
        {"/nodes/0/scale", ChannelPath::scale, 0, 3},
        {"/nodes/1/weights", ChannelPath::weights, 1, 0},
        {"/meshes/0/weights/2", ChannelPath::mesh_weights, 0, 1},
        {"/nodes/0/extensions/KHR_node_visibility/visible", ChannelPath::visible, 0, 1},
        {"/cameras/0/perspective/zfar", ChannelPath::json, 0, 1},
        {"/cameras/0/extensions/OBSCURA_camera/lens/fstop", ChannelPath::json, -1, 1},
        {"/extensions/KHR_lights_punctual/lights/1/color", ChannelPath::json, 1, 3},
        {"/extensions/KHR_lights_punctual/lights/0/spot/innerConeAngle", ChannelPath::json, 0, 1},
        {"/materials/0/pbrMetallicRoughness/baseColorFactor", ChannelPath::json, 0, 4},
        {"/materials/0/normalTexture/scale", ChannelPath::json, 0, 1},
        {"/materials/0/occlusionTexture/strength", ChannelPath::json, 0, 1},
        {"/materials/0/extensions/KHR_materials_ior/ior", ChannelPath::json, 0, 1},
        {"/materials/0/normalTexture/extensions/KHR_texture_transform/offset",
         ChannelPath::json,
         -1,
         2},
        {"/materials/0/extensions/KHR_materials_sheen/sheenColorTexture/extensions/"
         "KHR_texture_transform/rotation",
         ChannelPath::json,
         -1,
         1},
    };
    for (const Good& row : rows) {
        const auto found = find_property(tree(), row.pointer);
        ASSERT_TRUE(found) << row.pointer;
        EXPECT_EQ(found->path, row.path) << row.pointer;
        EXPECT_EQ(found->target, row.target) << row.pointer;
        EXPECT_EQ(found->width, row.width) << row.pointer;
        EXPECT_TRUE(found->in_use) << row.pointer;
    }
    EXPECT_EQ(find_property(tree(), "/meshes/0/weights/2")->element, 2);
    const char* hidden = "/nodes/0/extensions/KHR_node_hoverability/hoverable";
    EXPECT_FALSE(find_property(tree(), hidden)->in_use);
}

TEST(AnimationPointer, FindsNothingElse) {
    for (const char* pointer :
         {"",
          "nodes/0/translation",
          "/nodes/2/translation",
          "/nodes/-1/translation",
          "/nodes/x/translation",
          "/nodes/0/name",
          "/nodes/0/translation/0",
          "/cameras/0/orthographic/xmag",
          "/cameras/0/extensions/OBSCURA_camera/lens/radius",
          "/materials/1/alphaCutoff",
          "/materials/0/emissiveTexture/extensions/KHR_texture_transform/scale",
          "/extensions/KHR_lights_punctual/lights/1/spot/innerConeAngle",
          "/materials/99999999999/alphaCutoff"}) {
        EXPECT_FALSE(find_property(tree(), pointer)) << pointer;
    }
}

}  // namespace
}  // namespace obscura
