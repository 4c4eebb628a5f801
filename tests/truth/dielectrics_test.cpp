// tests/truth/dielectrics_test.cpp - absorption, nested dielectrics, dispersion.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "truth/dielectric_scene.h"

namespace obscura::test {
namespace dielectrics_truth {

/// The radiance of a slab at normal incidence with a white sky on both sides: reflections inside it
/// add up, and absorption acts on each passage.
double slab(double ior, double sigma, double thickness) {
    const double r = square((ior - 1) / (ior + 1));
    const double t = std::exp(-sigma * thickness);
    const double passed = square(1 - r) * t / (1 - r * r * t * t);
    const double returned = r + square(1 - r) * r * t * t / (1 - r * r * t * t);
    return passed + returned;
}

TEST(Dielectrics, SlabsAbsorbByTheirThickness) {
    for (const float ior : {1.0f, 1.5f, 2.4f}) {
        for (const float thickness : {0.1f, 0.5f, 2.0f}) {
            DielectricScene scene;
            const int32_t index = scene.add(dielectric(ior, {0.0f, 0.7f, 3.0f}));
            scene.box({-9, -9, -thickness}, {9, 9, 0}, index);
            const Vec3d seen = seen_from_front(scene.take());
            const auto d = static_cast<double>(thickness);
            const auto n = static_cast<double>(ior);
            EXPECT_NEAR(seen.x, 1, 0.005) << ior << ", " << thickness;
            EXPECT_NEAR(seen.y, slab(n, 0.7, d), 0.006) << ior << ", " << thickness;
            EXPECT_NEAR(seen.z, slab(n, 3, d), 0.006) << ior << ", " << thickness;
        }
    }
}

/// Along the axis a ray goes through the centre, whatever the index.
TEST(Dielectrics, SpheresAbsorbAlongTheDiameter) {
    DielectricScene scene;
    const int32_t index = scene.add(dielectric(1.2f, {0.5f, 0.5f, 0.5f}));
    scene.builder.sphere({0, 0, 0}, 1, 64, index);
    EXPECT_NEAR(seen_from_front(scene.take()).x, slab(1.2, 0.5, 2), 0.006);
}

/// A liquid that overlaps its glass ends where the glass begins: as without the overlap.
TEST(Dielectrics, TheDenserOfTwoOverlappingMediaDominates) {
    const auto filled = [](float overlap) {
        DielectricScene scene;
        const int32_t glass = scene.add(dielectric(1.5f, {0.3f, 0.0f, 0.0f}));
        const int32_t liquid = scene.add(dielectric(1.33f, {0.0f, 0.4f, 0.0f}));
        scene.box({-9, -9, -1}, {9, 9, 0}, glass);
        scene.box({-8, -8, -3}, {8, 8, -1 + overlap}, liquid);
        return seen_from_front(scene.take());
    };
    const Vec3d overlapping = filled(0.4f);
    // 1 m of glass and 2 m of liquid, whatever lies inside the glass.
    EXPECT_NEAR(overlapping.y, std::exp(-0.8), 0.06);
    const Vec3d deeper = filled(0.8f);
    EXPECT_NEAR(overlapping.x, deeper.x, 0.004);
    EXPECT_NEAR(overlapping.y, deeper.y, 0.004);
}

/// A wall 2 m deep in a medium, lit by a lamp 1 m from it: both distances absorb.
TEST(Dielectrics, LampsInsideShineThroughTheMedium) {
    const auto lit_wall = [](float absorption) {
        DielectricScene scene;
        const int32_t index = scene.add(dielectric(1.0f, {absorption, absorption, absorption}));
        scene.box({-9, -9, -20}, {9, 9, 0}, index);
        scene.builder.quad(
            {-5, -5, -2}, {10, 0, 0}, {0, 10, 0}, scene.builder.material(Material{}));
        Scene built = scene.take();
        PunctualLight lamp;
        lamp.position[0] = 0.6f;  // beside the axis: not seen itself through the surface
        lamp.position[2] = -1.2f;
        built.lights.push_back(lamp);
        return seen_from_front(std::move(built), {.bounces = 1, .sky = 0}).x;
    };
    EXPECT_NEAR(lit_wall(0.5f) / lit_wall(0.0f), std::exp(-1.5), 0.005);
}

/// The camera is 1000 m from the origin, inside the medium, 500 m from its boundary.
TEST(Dielectrics, BetweenACameraInsideAndTheBoundaryLightIsAbsorbed) {
    for (const float absorption : {0.0f, 1e-3f}) {
        DielectricScene scene;
        const int32_t index = scene.add(dielectric(1.5f, {absorption, absorption, absorption}));
        scene.box({-9000, -9000, 500}, {9000, 9000, 20000}, index);
        const double r = square(0.5 / 2.5);
        const double way = std::exp(-500 * static_cast<double>(absorption));
        const double back = std::exp(-19500 * static_cast<double>(absorption));
        const double reflected = r * back * ((1 - r) / (1 - r * back));
        EXPECT_NEAR(seen_from_front(scene.take()).x, way * (1 - r + reflected), 0.005);
    }
}

/// The denser of two solids around the camera is the dominant medium.
TEST(Dielectrics, ACameraMayBeInsideTwoMedia) {
    DielectricScene scene;
    const int32_t thin = scene.add(dielectric(1.01f, {1, 1, 1}));
    const int32_t dense = scene.add(dielectric(1.02f, {1e-3f, 1e-3f, 1e-3f}));
    scene.box({-9000, -9000, -1}, {9000, 9000, 20000}, dense);
    scene.box({-800, -800, 700}, {800, 800, 1300}, thin);
    EXPECT_NEAR(seen_from_front(scene.take()).x, std::exp(-1.001), 0.01);
}

/// A block of flint before a white sky.
Scene flint_block(float absorption) {
    DielectricScene scene;
    MaterialLayers flint = dielectric(1.6f, {absorption, absorption, absorption});
    flint.dispersion = 1;
    scene.box({-9, -9, -1}, {9, 9, 0}, scene.add(flint));
    return scene.take();
}

TEST(Dielectrics, DispersionHasNoColourWhereNothingBends) {
    const Vec3d seen = seen_from_front(flint_block(0));
    EXPECT_NEAR(seen.x, 1, 0.004);
    EXPECT_NEAR(seen.y, 1, 0.004);
    EXPECT_NEAR(seen.z, 1, 0.004);
}

/// A pixel's wavelengths are spread evenly: 64 random ones would be 0.15 off white.
TEST(Dielectrics, DispersionHasLittleColourInAnyPixel) {
    for (const Mean& channel : means_from_front(flint_block(0), {.samples = 64})) {
        const double pixel_error = channel.error * image_size;
        EXPECT_LT(pixel_error, 0.05);
    }
}

/// Light that is not transmitted has no wavelength.
TEST(Dielectrics, ReflectionsOffDispersiveDielectricsAreWhite) {
    const auto means = means_from_front(flint_block(1000), {.samples = 1});
    EXPECT_GT(means[0].value, 0);
    EXPECT_EQ(means[0].value, means[1].value);
    EXPECT_EQ(means[0].value, means[2].value);
    const Vec3d seen = seen_from_front(flint_block(1000));
    EXPECT_NEAR(seen.x, square(0.6 / 2.6), 0.003);
}

}  // namespace dielectrics_truth
}  // namespace obscura::test
