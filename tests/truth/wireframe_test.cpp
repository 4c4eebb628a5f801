// tests/truth/wireframe_test.cpp - lines of the requested width, measured on images.
// SPDX-License-Identifier: Apache-2.0
#include "camera/camera_models.h"

#include <gtest/gtest.h>

#include "support/shape_scenes.h"
#include "truth/reference.h"

namespace obscura::test {
namespace wireframe_truth {

constexpr int width = 96;
constexpr int height = 72;

Film wires(const Scene& scene, const Camera& camera, double line_px, int tile = 16) {
    RenderOptions options;
    options.width = width;
    options.height = height;
    options.integrator = Integrator::wireframe;
    options.wire_width_px = line_px;
    options.tile_size = tile;
    return render_scene(scene, {}, camera, options).film;
}

/// Sum of one image row: the number of its pixels covered by lines.
double covered(const Film& film, int row, int first = 0, int last = width) {
    double sum = 0;
    for (int x = first; x < last; ++x)
        sum += static_cast<double>(film.pixels[4 * static_cast<size_t>(row * width + x)]);
    return sum;
}

Material double_sided() {
    Material m;
    m.flags = material_double_sided;
    return m;
}

TEST(Wireframe, ADiagonalIsAsWideAsAsked) {
    // The diagonal of a tilted quad, seen from the side: its ends are projected here, and a line of
    // width w that moves m pixels sideways for each row covers w sqrt(1 + m^2) of every row.
    SceneBuilder builder;
    builder.quad({-1, -1, 0.4f}, {2, 0, -0.7f}, {0.2f, 2, 0.3f}, builder.material(double_sided()));
    const Scene scene = builder.take();
    const Camera camera = look_at({1.5f, 0.5f, 4}, {0.6f, 0.2f, 0}, 0.6f, width, height);
    const auto pixel = [&](const Vec3f& p) {
        const Vec2<double> film = project(camera, widen(p)).value();
        return Vec2<double>{film.x * width, film.y * height};
    };
    const Vec2<double> a = pixel({-1, -1, 0.4f});
    const Vec2<double> b = pixel({1.2f, 1, 0});
    const double slope = (b.x - a.x) / (b.y - a.y);
    for (const double line_px : {1.0, 2.5, 5.0}) {
        const Film film = wires(scene, camera, line_px);
        double sum = 0;
        int rows = 0;
        for (int y = 26; y < 46; ++y) {
            const double middle = a.x + slope * (y + 0.5 - a.y);
            const int reach = 12;
            sum += covered(
                film, y, static_cast<int>(middle) - reach, static_cast<int>(middle) + reach + 1);
            ++rows;
        }
        const double expected = line_px * std::sqrt(1 + slope * slope);
        EXPECT_NEAR(sum / rows, expected, 0.01 * expected) << line_px;
    }
}

TEST(Wireframe, LinesAreAsWideInEveryCamera) {
    // Two sheets that meet in the plane x = 0, which is the image's middle column for all.
    SceneBuilder builder;
    const int32_t index = builder.material(double_sided());
    builder.quad({-4, -9, -3}, {4, 0, 0}, {0, 18, 0}, index);
    builder.quad({0, -9, -3}, {4, 0, 0}, {0, 18, 0}, index);
    const Scene scene = builder.take();
    for (NamedCamera& named : all_cameras()) {
        const Camera& c = named.camera;
        if (c.pinhole.shift_x != 0 || is_distorted(c)) continue;
        named.camera.world_from_camera = {};
        int column = width / 2;
        int middle_row = height / 2;
        if (c.model == CameraModel::environment &&
            c.environment.projection == EnvironmentProjection::cubemap) {
            column = width * 5 / 6;  // the front is the last of three columns, in the lower row
            middle_row = height * 3 / 4;
        }
        if (c.environment.half_eyes_m > 0) continue;  // no eye stands in the plane
        for (const double line_px : {1.0, 3.0}) {
            const Film film = wires(scene, named.camera, line_px);
            // Off the central row, where diagonals pass. The widths are right to first order: the
            // cube's pixels of 3 degrees show the rest.
            const double sum = covered(film, middle_row + 2, column - 3, column + 3);
            EXPECT_NEAR(sum, line_px, 0.008 * line_px) << named.name;
        }
    }
}

TEST(Wireframe, ShapesShowEveryEighthOfTheirCoordinates) {
    Scene scene = empty_scene(double_sided());
    ShapeRecord plane = make_shape(ShapeKind::plane, 2, 2);
    add_shape(scene, plane, 0);
    Camera camera = look_at({0, 5, 0}, {0, 0, 0}, 0.5f, width, height);
    camera.model = CameraModel::orthographic;
    camera.orthographic = {2, 1.5f, 3.0f / height};
    const Film film = wires(scene, camera, 1.5);
    // 4 m wide, 96 pixels: a line every 12 pixels; the outer two show half their width.
    EXPECT_NEAR(covered(film, 30), 8 * 1.5, 0.05);
    EXPECT_NEAR(covered(film, 30, 6, 18), 1.5, 0.01);
    EXPECT_NEAR(covered(film, 30, 14, 22), 0, 1e-6);
}

TEST(Wireframe, SilhouettesAreSmoothAndTilesDoNotShow) {
    SceneBuilder builder;
    builder.sphere({0, 0, 0}, 1, 6, builder.material({}));
    const Scene scene = builder.take();
    const Camera camera = look_at({0, 1, 4}, {0, 0, 0}, 0.6f, width, height);
    const Film film = wires(scene, camera, 1);
    EXPECT_EQ(film.pixels, wires(scene, camera, 1, 7).pixels);
    int between = 0;
    for (size_t i = 3; i < film.pixels.size(); i += 4)
        between += film.pixels[i] > 0 && film.pixels[i] < 1 ? 1 : 0;
    EXPECT_GT(between, 100) << "alpha is the share of the pixel that the mesh covers";
}

}  // namespace wireframe_truth
}  // namespace obscura::test
