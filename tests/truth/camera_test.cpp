// tests/truth/camera_test.cpp - images of small lights: positions and blur.
// SPDX-License-Identifier: Apache-2.0
#include "camera/lens_equation.h"
#include "camera/project.h"
#include "render/film_rows.h"

#include <gtest/gtest.h>

#include "support/scene_builder.h"

namespace obscura::test {
namespace camera_truth {

constexpr int image_size = 64;

Material lamp() {
    Material m;
    std::fill_n(m.base_color, 3, 0.0f);
    m.metallic = 0;
    m.flags = material_double_sided;
    std::fill_n(m.emission, 3, 1.0f);
    return m;
}

/// A square lamp of the given width that faces the origin.
void add_lamp(SceneBuilder& builder, int32_t index, const Vec3f& place, float width) {
    const Vec3f back = normalize(place * -1.0f);
    const Vec3f hint = std::fabs(back.y) > 0.9f ? Vec3f{1, 0, 0} : Vec3f{0, 1, 0};
    const Vec3f right = normalize(cross(hint, back));
    const Vec3f up = cross(back, right);
    builder.quad(place - (right + up) * (0.5f * width), right * width, up * width, index);
}

Film image_of(SceneBuilder builder, const Camera& camera, int width, int samples) {
    RenderOptions options;
    options.width = width;
    options.height = image_size;
    options.samples_per_pixel = samples;
    options.integrator = Integrator::direct;
    options.background = BackgroundKind::transparent;
    return render_scene(builder.take(), {}, camera, options).film;
}

/// The position of a film's light in pixels, and its spread.
struct Spot {
    double sum = 0, x = 0, y = 0;
    double variance = 0;  ///< mean of both directions, px^2
};

/// Within the columns [first, last).
Spot measure(const Film& film, int first, int last) {
    Spot spot;
    double squares = 0;
    const ImagePart part = film.part_of.value_or(ImagePart{});
    for (int y = part.y; y < part.y + film.height; ++y) {
        for (int x = std::max(first, part.x); x < std::min(last, part.x + film.width); ++x) {
            const double v = static_cast<double>(film.pixels[4 * pixel_index(film, x, y)]);
            spot.sum += v;
            spot.x += v * (x + 0.5);
            spot.y += v * (y + 0.5);
            squares += v * ((x + 0.5) * (x + 0.5) + (y + 0.5) * (y + 0.5));
        }
    }
    spot.x /= spot.sum;
    spot.y /= spot.sum;
    spot.variance = 0.5 * (squares / spot.sum - spot.x * spot.x - spot.y * spot.y);
    return spot;
}

Camera pinhole_of(double tan_half_yfov) {
    Camera camera;
    camera.pinhole.tan_half_yfov = static_cast<float>(tan_half_yfov);
    camera.pinhole.aspect = 1;
    camera.pinhole.pixel_spread = 2 * camera.pinhole.tan_half_yfov / image_size;
    return camera;
}

constexpr double focal_m = 0.05;
constexpr double opening_m = focal_m / 1.4;
constexpr double focus_m = 2;

/// Through a 50 mm lens at f/1.4 that is focused at 2 m, with a film of the given height.
Camera lens_of(double film_height_m) {
    Camera camera = pinhole_of(film_height_m / (2 * image_distance(focal_m, focus_m)));
    camera.model = CameraModel::thin_lens;
    camera.thin_lens.aperture.radius_m = static_cast<float>(opening_m / 2);
    camera.thin_lens.inverse_focus = static_cast<float>(1 / focus_m);
    return camera;
}

class CircleOfConfusion : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Distances,
                         CircleOfConfusion,
                         testing::Values(0.5, 0.8, 1.1, 1.4, 1.7, 2.4, 3.0, 5.0, 12.0, 60.0));

/// The film is so large that the patch is 36 pixels wide; the light, one pixel.
TEST_P(CircleOfConfusion, OfAPointOfLightIsThatOfTheLensEquation) {
    const double distance = GetParam();
    const double expected = circle_of_confusion(opening_m, focal_m, focus_m, distance);
    const double pixel_m = expected / 36;
    const double light_px = 2;
    const double width = light_px * pixel_m * distance / image_distance(focal_m, focus_m);
    SceneBuilder builder;
    add_lamp(builder,
             builder.material(lamp()),
             {0, 0, static_cast<float>(-distance)},
             static_cast<float>(width));
    const Spot spot =
        measure(image_of(std::move(builder), lens_of(pixel_m * image_size), image_size, 1024),
                0,
                image_size);
    // A disk of diameter c has the variance c^2 / 16; the square light and the pixels add theirs.
    const double variance = spot.variance - (light_px * light_px + 1) / 12;
    EXPECT_NEAR(4 * std::sqrt(variance) * pixel_m, expected, 0.02 * expected);
}

TEST(ThinLens, WhatIsInFocusIsSharp) {
    SceneBuilder builder;
    const double pixel_m = 1e-5;
    const double width = 4 * pixel_m * focus_m / image_distance(focal_m, focus_m);
    add_lamp(builder, builder.material(lamp()), {0, 0, -2}, static_cast<float>(width));
    const Film film = image_of(std::move(builder), lens_of(pixel_m * image_size), image_size, 64);
    for (int y = 0; y < image_size; ++y) {
        for (int x = 0; x < image_size; ++x) {
            const bool inside = std::abs(x - 31.5) < 2 && std::abs(y - 31.5) < 2;
            const bool outside = std::abs(x - 31.5) > 3 || std::abs(y - 31.5) > 3;
            const float alpha = film.pixels[4 * static_cast<size_t>(y * image_size + x) + 3];
            if (inside) {
                EXPECT_EQ(alpha, 1);
            }
            if (outside) {
                EXPECT_EQ(alpha, 0);
            }
        }
    }
}

TEST(ThinLens, RadiusZeroRendersThePinholesImageBitForBit) {
    const auto scene = [] {
        SceneBuilder builder;
        Material white;
        white.metallic = 0;
        builder.sphere({0, 0, -4}, 1, 16, builder.material(white));
        return builder;
    };
    Camera lens = lens_of(0.03);
    lens.thin_lens.aperture.radius_m = 0;
    Camera pinhole = lens;
    pinhole.model = CameraModel::pinhole;
    EXPECT_EQ(image_of(scene(), lens, 96, 8).pixels, image_of(scene(), pinhole, 96, 8).pixels);
    Camera open = lens_of(0.03);
    EXPECT_NE(image_of(scene(), open, 96, 8).pixels, image_of(scene(), pinhole, 96, 8).pixels);
}

/// The centre of a lamp some pixels wide, in a large image of which only the lamp's surroundings
/// are rendered.
Spot lamp_in_fisheye(const Camera& camera, const Vec3d& place, int size_px) {
    SceneBuilder builder;
    const Vec3f at{
        static_cast<float>(place.x), static_cast<float>(place.y), static_cast<float>(place.z)};
    add_lamp(builder, builder.material(lamp()), at, 0.2f);
    const auto film = project(camera, place);
    RenderOptions options;
    options.width = options.height = size_px;
    options.samples_per_pixel = 256;
    options.integrator = Integrator::direct;
    options.background = BackgroundKind::transparent;
    options.crop = PixelRect{
        static_cast<int>(film->x * size_px) - 8, static_cast<int>(film->y * size_px) - 8, 16, 16};
    return measure(render_scene(builder.take(), {}, camera, options).film, 0, size_px);
}

TEST(Fisheye, LampsAreSeenWhereTheLawPutsThem) {
    constexpr int size_px = 1024;
    for (const FisheyeLaw law :
         {FisheyeLaw::equidistant, FisheyeLaw::equisolid, FisheyeLaw::stereographic}) {
        Camera camera;
        camera.model = CameraModel::fisheye;
        FisheyeCamera& fisheye = camera.fisheye;
        fisheye.law = law;
        fisheye.largest_angle = static_cast<float>(110 * pi_d / 180);
        fisheye.largest_radius = fisheye_radius(fisheye, fisheye.largest_angle);
        fisheye.half_width = fisheye.half_height = fisheye.largest_radius;
        for (const double theta_deg : {20.0, 70.0, 100.0}) {
            const double theta = theta_deg * pi_d / 180;
            const Spot spot = lamp_in_fisheye(
                camera,
                Vec3d{8 * std::sin(theta), 6 * std::sin(theta), -10 * std::cos(theta)},
                size_px);
            const double radius = law == FisheyeLaw::equidistant ? theta
                                  : law == FisheyeLaw::equisolid ? 2 * std::sin(theta / 2)
                                                                 : 2 * std::tan(theta / 2);
            const double from_centre =
                radius / static_cast<double>(fisheye.largest_radius) * size_px / 2;
            EXPECT_NEAR(spot.x, size_px / 2 + 0.8 * from_centre, 0.05);
            EXPECT_NEAR(spot.y, size_px / 2 - 0.6 * from_centre, 0.05);
        }
    }
}

TEST(Fisheye, OutsideTheCircleThereIsNothingAndNoRayIsRefused) {
    SceneBuilder builder;
    Material white;
    white.metallic = 0;
    builder.sphere({0, 0, 0}, 5, 16, builder.material(white), true);
    LightingOptions lighting;
    lighting.environment = constant_environment(1.0f);
    Camera camera;
    camera.model = CameraModel::fisheye;
    camera.fisheye.half_width = camera.fisheye.half_height = camera.fisheye.largest_radius;
    for (const bool sees_scene : {true, false}) {
        camera.far_m = sees_scene ? 0.0f : 1.0f;  // else the background is seen
        RenderOptions options;
        options.width = options.height = image_size;
        options.samples_per_pixel = 4;
        const RenderResult result =
            render_scene(SceneBuilder(builder).take(), lighting, camera, options);
        EXPECT_EQ(result.counters.refused_rays, 0U);
        EXPECT_EQ(result.counters.nonfinite_samples, 0U);
        const auto alpha = [&](int x, int y) {
            return result.film.pixels[4 * static_cast<size_t>(y * image_size + x) + 3];
        };
        EXPECT_EQ(alpha(0, 0), 0);
        EXPECT_EQ(result.film.pixels[0], 0);
        EXPECT_EQ(alpha(32, 32), 1);
        EXPECT_EQ(alpha(32, 1), 1);
    }
}

/// A lamp straight ahead of both eyes, 2 m away: each sees it turned inwards by asin(half / 2).
TEST(Stereo, TheEyesSeeALampUnderTheirAngle) {
    Camera camera;
    camera.model = CameraModel::environment;
    camera.environment.half_eyes_m = 0.2f;
    constexpr int width = 256;
    SceneBuilder builder;
    add_lamp(builder, builder.material(lamp()), {0, 0, -2}, 0.1f);
    RenderOptions options;
    options.width = width;
    options.height = 128;
    options.samples_per_pixel = 512;
    options.integrator = Integrator::direct;
    options.background = BackgroundKind::transparent;
    const Film film = render_scene(builder.take(), {}, camera, options).film;
    Film eye[2] = {{width, 64, film.channels, {}}, {width, 64, film.channels, {}}};
    const auto middle = film.pixels.begin() + 4 * width * 64;
    eye[0].pixels.assign(film.pixels.begin(), middle);
    eye[1].pixels.assign(middle, film.pixels.end());
    const double turned = std::asin(0.2 / 2) / (2 * pi_d) * width;
    EXPECT_NEAR(measure(eye[0], 0, width).x, width / 2.0 + turned, 0.05);
    EXPECT_NEAR(measure(eye[1], 0, width).x, width / 2.0 - turned, 0.05);
    EXPECT_NEAR(measure(eye[0], 0, width).y, 32, 0.05);
}

TEST(Clipping, HidesWhatIsTooNearOrTooFarAndKeepsDepths) {
    const auto depth_at_centre = [](const Camera& camera) {
        SceneBuilder builder;
        const int32_t index = builder.material(lamp());
        builder.quad({-1, -1, -2}, {2, 0, 0}, {0, 2, 0}, index);
        builder.quad({-5, -5, -4}, {10, 0, 0}, {0, 10, 0}, index);
        RenderOptions options;
        options.width = options.height = 8;
        options.integrator = Integrator::depth;
        return render_scene(builder.take(), {}, camera, options).film.pixels[4 * 8 + 4];
    };
    Camera camera = pinhole_of(0.3);
    EXPECT_NEAR(depth_at_centre(camera), 2, 1e-5);
    camera.near_m = 1;
    EXPECT_NEAR(depth_at_centre(camera), 2, 1e-5);
    camera.near_m = 3;
    EXPECT_NEAR(depth_at_centre(camera), 4, 1e-5);
    camera.far_m = 3.9f;
    EXPECT_EQ(depth_at_centre(camera), 0);
    camera.far_m = 4.1f;
    EXPECT_NEAR(depth_at_centre(camera), 4, 1e-5);
}

/// Any tile size, with a lens, clipping and distortion, which lanes must not exchange.
TEST(Cameras, TilesDoNotChangeTheImage) {
    const auto shot = [](int tile_size) {
        SceneBuilder builder;
        Material white;
        white.metallic = 0;
        builder.sphere({0, 0, -2}, 1, 16, builder.material(white));
        Camera camera = lens_of(0.03);
        camera.far_m = 1.9f;
        camera.distortion = {-0.3f, 0.1f, 0.01f, 0.01f, 0, 1.2f};
        RenderOptions options;
        options.width = 50;
        options.height = 34;
        options.samples_per_pixel = 5;
        options.tile_size = tile_size;
        return render_scene(builder.take(), {}, camera, options).film.pixels;
    };
    const UnsetArray<float> whole = shot(16);
    EXPECT_EQ(whole, shot(7));
    EXPECT_EQ(whole, shot(64));
}

}  // namespace camera_truth
}  // namespace obscura::test
