// tests/scene/touching_media_test.cpp - which boundaries of media may share faces.
// SPDX-License-Identifier: Apache-2.0
#include "scene/touching_media.h"

#include <gtest/gtest.h>

namespace obscura::test {
namespace {

/// Triangles between x = low and x = high; materials 0 and 1 bound media, 2 does not.
class Row {
public:
    Row() {
        scene_.materials.resize(3);
        scene_.layers.resize(2);
        scene_.media.resize(3);
        for (int32_t i = 0; i < 2; ++i) {
            scene_.materials[static_cast<size_t>(i)].layers = i;
            scene_.layers[static_cast<size_t>(i)].medium = i + 1;
        }
    }
    void add(float low, float high, int32_t material) {
        const auto first = static_cast<uint32_t>(scene_.positions.size() / 3);
        Primitive primitive;
        primitive.first_triangle = static_cast<int32_t>(scene_.indices.size() / 3);
        primitive.triangle_count = 1;
        primitive.material = material;
        scene_.primitives.push_back(primitive);
        scene_.positions.insert(scene_.positions.end(), {low, 0, 0, high, 1, 0, low, 0, 1});
        scene_.indices.insert(scene_.indices.end(), {first, first + 1, first + 2});
        ++scene_.world_primitive_count;
    }
    /// Places the last primitive twice instead.
    void place_last(float x, float other_x) {
        --scene_.world_primitive_count;
        scene_.meshes.push_back({scene_.world_primitive_count, 1});
        for (const float to : {x, other_x}) {
            Instance instance;
            instance.world_from_object.m[0][3] = to;
            instance.object_from_world.m[0][3] = -to;
            scene_.instances.push_back(instance);
        }
    }
    std::vector<int32_t> touching() const { return find_touching_media(scene_); }

private:
    Scene scene_;
};

TEST(TouchingMedia, ScenesWithOneMediumOrMediaApartHaveNone) {
    Row one;
    one.add(0, 1, 0);
    one.add(1, 2, 2);  // opaque
    EXPECT_TRUE(one.touching().empty());
    Row apart;
    apart.add(0, 1, 0);
    apart.add(1.1f, 2, 1);
    EXPECT_TRUE(apart.touching().empty());
}

TEST(TouchingMedia, HaveTheNumbersOfTheirMedia) {
    Row row;
    row.add(0, 1, 0);
    row.add(3, 4, 1);
    row.add(1, 2, 1);
    row.add(0, 5, 2);
    EXPECT_EQ(row.touching(), (std::vector<int32_t>{1, 0, 2, 0}));
}

TEST(TouchingMedia, InstancesTouchEachOther) {
    Row row;
    row.add(0, 1, 0);
    row.place_last(0, 1);
    EXPECT_EQ(row.touching(), std::vector<int32_t>{1});
    Row apart;
    apart.add(0, 1, 0);
    apart.place_last(0, 3);
    EXPECT_TRUE(apart.touching().empty());
}

}  // namespace
}  // namespace obscura::test
