// tests/accel/reference_kernels_test.cpp - every way to query Embree gives the renderer's answers.
// SPDX-License-Identifier: Apache-2.0
#include "accel/reference_kernels.h"

#include "accel/accel_scenes.h"

#include <gtest/gtest.h>

#include "support/shape_scenes.h"

namespace obscura {
namespace {

using namespace test;

/// A mesh, a sphere, particles, an infinite plane and an instance of a box.
Scene mixed_scene() {
    SceneBuilder builder;
    builder.quad({-1, -1, -0.5F}, {2, 0.1F, 0}, {0, 2, 0.2F}, builder.material({}));
    Scene scene = builder.take();
    add_shape(scene, make_shape(ShapeKind::sphere, 0.6F), 0);
    add_spheres(scene, {1, 1, 0, 0.3F, -1, 1, 0.2F, 0.25F, 0, -1, 0.4F, 0.2F}, 0);
    ShapeRecord floor = make_shape(ShapeKind::plane, unbounded, unbounded);
    floor.centre[1] = -2;
    add_shape(scene, floor, 0);
    add_shape(scene, make_shape(ShapeKind::box, 0.2F, 0.3F, 0.4F), 0, scaling(1, 2, -1, {1, 0, 0}));
    return scene;
}

/// The answers of the renderer's own queries, and room for those of others.
class ReferenceKernelsTest : public testing::Test {
protected:
    ReferenceKernelsTest() : built_(build(mixed_scene())) {
        Pcg32 random(3);
        for (int i = 0; i < count_; ++i)
            rays_.add(random_in_cube(random, 3.0F), random_unit(random));
        rays_.add({0, 0, NAN}, {0, 0, 1});
        EXPECT_EQ(rays_.intersect(built_.accel, Coherence::incoherent), 1);
        rays_.occlude(built_.accel, Coherence::incoherent);
    }

    RayColumns columns() {
        for (auto& column : column_)
            column.clear();
        for (int i = 0; i <= count_; ++i) {
            const Vec3f o = rays_.origin(i);
            const Vec3f d = rays_.direction(i);
            const float numbers[6] = {o.x, o.y, o.z, d.x, d.y, d.z};
            for (size_t c = 0; c < 6; ++c)
                column_[c].push_back(numbers[c]);
        }
        key_.assign(column_[0].size(), 0);
        return {column_[0].data(),
                column_[1].data(),
                column_[2].data(),
                column_[3].data(),
                column_[4].data(),
                column_[5].data(),
                nullptr,
                key_.data(),
                count_ + 1};
    }

    /// Rays on which the kernel disagrees with the renderer.
    int differences(const KernelChoice& choice, int width) {
        const auto kernels = ReferenceKernels::build(*built_.scene, choice);
        if (!kernels) throw std::runtime_error(kernels.error().message);
        const size_t padded = static_cast<size_t>(count_) + 17;
        std::vector<float> t(padded), u(padded), v(padded);
        std::vector<int32_t> instance(padded), primitive(padded), triangle(padded);
        std::vector<uint8_t> occluded(padded);
        kernels->intersect(
            columns(),
            {t.data(), u.data(), v.data(), instance.data(), primitive.data(), triangle.data()},
            width);
        kernels->occluded(columns(), occluded.data(), width);
        int differ = 0;
        for (int i = 0; i < count_; ++i) {
            const auto at = static_cast<size_t>(i);
            const bool hit = primitive[at] >= 0;
            bool same = hit == rays_.hit(i) && (occluded[at] != 0) == hit;
            if (same && hit) {
                same = primitive[at] == rays_.primitive[at] && triangle[at] == rays_.triangle[at] &&
                       instance[at] == rays_.instance[at] &&
                       std::abs(t[at] - rays_.t[at]) <= 1e-5F * (1 + rays_.t[at]);
            }
            differ += same ? 0 : 1;
        }
        EXPECT_EQ(primitive.at(static_cast<size_t>(count_)), -1) << "not finite";
        return differ;
    }

    static constexpr int count_ = 5003;  ///< no whole packets
    BuiltScene built_;
    RayList rays_;
    std::vector<float> column_[6];
    std::vector<uint32_t> key_;
};

TEST_F(ReferenceKernelsTest, EveryWidthAgrees) {
    for (const int width : {1, 4, 8, 16}) {
        EXPECT_EQ(differences({}, width), 0) << width;
        KernelChoice fast;
        fast.robust = false;
        EXPECT_LE(differences(fast, width), 1) << width;
    }
}

TEST_F(ReferenceKernelsTest, EveryInstructionSetAgrees) {
    for (const std::string& isa : embree_isas()) {
        KernelChoice choice;
        choice.isa = isa;
        EXPECT_LE(differences(choice, 16), 1) << isa;
    }
}

TEST_F(ReferenceKernelsTest, StandInsAgree) {
    KernelChoice choice;
    choice.user_triangles = true;
    choice.sphere_points = true;
    for (const int width : {1, 4, 8, 16})
        EXPECT_LE(differences(choice, width), 1) << width;
}

/// A sphere whose cut-out keeps nothing, and a wall behind it.
TEST(ShapeCutOuts, AMaskedShapeIsNotThere) {
    for (const float cutoff : {0.0F, 2.0F}) {
        Material material;
        material.flags |= material_alpha_mask;
        material.alpha_cutoff = cutoff;
        Scene scene = empty_scene(material);
        add_shape(scene, make_shape(ShapeKind::sphere, 1), 0);
        add_shape(scene, make_shape(ShapeKind::box, 1, 1, 1), 0, scaling(1, 1, 1, {4, 0, 0}));
        const BuiltScene built = build(std::move(scene));
        RayList rays;
        rays.add({0, 0, 5}, {0, 0, -1});
        rays.add({4, 0, 5}, {0, 0, -1});
        rays.intersect(built.accel, Coherence::coherent);
        rays.occlude(built.accel, Coherence::coherent);
        for (int i = 0; i < 2; ++i) {
            EXPECT_EQ(rays.hit(i), cutoff < 1) << i;
            EXPECT_EQ(rays.occluded[static_cast<size_t>(i)], cutoff < 1 ? 1 : 0) << i;
        }
    }
}

}  // namespace
}  // namespace obscura
