// tests/support/scene_builder.h - small scenes in memory, for tests that need no file.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/render.h"

#include <cmath>
#include <vector>

namespace obscura::test {

/// Builds a Scene primitive by primitive, all in world space.
class SceneBuilder {
public:
    SceneBuilder() {
        scene_.materials.clear();
        scene_.positions.clear();
    }

    /// Adds a material and returns its index.
    int32_t material(const Material& m) {
        scene_.materials.push_back(m);
        scene_.material_numbers.push_back(static_cast<int32_t>(scene_.material_numbers.size()));
        scene_.material_names.push_back("material " + std::to_string(scene_.materials.size()));
        return static_cast<int32_t>(scene_.materials.size()) - 1;
    }

    /// A parallelogram with corners p, p + a, p + a + b, p + b; its front is cross(a, b).
    void quad(const Vec3f& p, const Vec3f& a, const Vec3f& b, int32_t material_index) {
        const uint32_t first = vertex_count();
        for (const Vec3f& v : {p, p + a, p + a + b, p + b})
            add_vertex(v);
        begin(material_index);
        triangle(first, first + 1, first + 2);
        triangle(first, first + 2, first + 3);
        end();
    }

    /// A sphere of `rings` x 2 `rings` quads; `inward`: its front faces the centre. With smooth
    /// normals unless `flat`.
    void sphere(const Vec3f& centre,
                float radius,
                int rings,
                int32_t material_index,
                bool inward = false,
                bool flat = false) {
        const uint32_t first = vertex_count();
        const int columns = 2 * rings;
        std::vector<float> normals;
        for (int r = 0; r <= rings; ++r) {
            for (int c = 0; c <= columns; ++c) {
                const double theta = pi_d * r / rings;
                const double phi = 2.0 * pi_d * c / columns;
                const Vec3f n{static_cast<float>(std::sin(theta) * std::cos(phi)),
                              static_cast<float>(std::cos(theta)),
                              static_cast<float>(std::sin(theta) * std::sin(phi))};
                add_vertex(centre + n * radius);
                const float sign = inward ? -1.0f : 1.0f;
                normals.insert(normals.end(), {sign * n.x, sign * n.y, sign * n.z});
            }
        }
        begin(material_index);
        if (!flat) {
            scene_.primitives.back().normal_base = static_cast<int32_t>(
                static_cast<int64_t>(scene_.attributes.size()) - 3 * static_cast<int64_t>(first));
            scene_.attributes.insert(scene_.attributes.end(), normals.begin(), normals.end());
        }
        const auto at = [&](int r, int c) {
            return first + static_cast<uint32_t>(r * (columns + 1) + c);
        };
        for (int r = 0; r < rings; ++r) {
            for (int c = 0; c < columns; ++c) {
                uint32_t corner[4] = {at(r, c), at(r, c + 1), at(r + 1, c + 1), at(r + 1, c)};
                if (inward) std::swap(corner[1], corner[3]);
                // At the poles one half of the quad has no area: the winding decides which one.
                const bool first_pole = r == 0;
                const bool last_pole = r + 1 == rings;
                if (!(inward ? last_pole : first_pole)) triangle(corner[0], corner[1], corner[2]);
                if (!(inward ? first_pole : last_pole)) triangle(corner[0], corner[2], corner[3]);
            }
        }
        end();
    }

    Scene take() {
        for (size_t i = 0; i + 2 < scene_.positions.size(); i += 3) {
            const float* p = &scene_.positions[i];
            scene_.bounds.low = {std::min(scene_.bounds.low.x, p[0]),
                                 std::min(scene_.bounds.low.y, p[1]),
                                 std::min(scene_.bounds.low.z, p[2])};
            scene_.bounds.high = max3(scene_.bounds.high, Vec3f{p[0], p[1], p[2]});
        }
        pad_tables(scene_);
        scene_.world_primitive_count = static_cast<int32_t>(scene_.primitives.size());
        if (scene_.materials.empty()) material({});
        return std::move(scene_);
    }

    Scene& scene() { return scene_; }

private:
    uint32_t vertex_count() const { return static_cast<uint32_t>(scene_.positions.size() / 3); }
    void add_vertex(const Vec3f& v) {
        scene_.positions.insert(scene_.positions.end(), {v.x, v.y, v.z});
    }
    void begin(int32_t material_index) {
        Primitive primitive;
        primitive.first_triangle = static_cast<int32_t>(scene_.indices.size() / 3);
        primitive.material = material_index;
        primitive.node = static_cast<int32_t>(scene_.primitives.size());
        scene_.primitives.push_back(primitive);
    }
    void triangle(uint32_t a, uint32_t b, uint32_t c) {
        scene_.indices.insert(scene_.indices.end(), {a, b, c});
    }
    void end() {
        Primitive& primitive = scene_.primitives.back();
        primitive.triangle_count =
            static_cast<int32_t>(scene_.indices.size() / 3) - primitive.first_triangle;
    }

    Scene scene_;
};

/// For LightingOptions::environment.
inline std::shared_ptr<const ImageRgb32f> shared(ImageRgb32f image) {
    return std::make_shared<const ImageRgb32f>(std::move(image));
}

/// A constant environment of the given radiance.
inline std::shared_ptr<const ImageRgb32f> constant_environment(float radiance) {
    ImageRgb32f image{16, 8, {}};
    image.pixels.assign(16 * 8 * 3, radiance);
    return shared(std::move(image));
}

/// A pinhole camera at `eye` that looks at `target`.
inline Camera look_at(
    const Vec3f& eye, const Vec3f& target, float yfov_rad, int width, int height) {
    const Vec3f back = normalize(eye - target);
    const Vec3f hint = std::fabs(back.y) > 0.99f ? Vec3f{0, 0, 1} : Vec3f{0, 1, 0};
    const Vec3f right = normalize(cross(hint, back));
    const Vec3f up = cross(back, right);
    Camera camera;
    const Vec3f columns[4] = {right, up, back, eye};
    for (int c = 0; c < 4; ++c) {
        camera.world_from_camera.m[0][c] = columns[c].x;
        camera.world_from_camera.m[1][c] = columns[c].y;
        camera.world_from_camera.m[2][c] = columns[c].z;
    }
    camera.pinhole.tan_half_yfov = std::tan(0.5f * yfov_rad);
    camera.pinhole.aspect = static_cast<float>(width) / static_cast<float>(height);
    camera.pinhole.pixel_spread = 2.0f * camera.pinhole.tan_half_yfov / static_cast<float>(height);
    return camera;
}

/// Prepares and renders; a failure becomes an exception, which fails the test.
inline RenderResult render_scene(Scene scene,
                                 LightingOptions lighting,
                                 const Camera& camera,
                                 const RenderOptions& options,
                                 Isa isa = Isa::automatic) {
    Log log(Verbosity::quiet);
    auto prepared = PreparedScene::create(std::move(scene), std::move(lighting), isa, log);
    if (!prepared) throw std::runtime_error(prepared.error().message);
    const std::atomic<bool> stop = false;
    auto result = render(*prepared, camera, options, {}, stop);
    if (!result) throw std::runtime_error(result.error().message);
    return std::move(*result);
}

}  // namespace obscura::test
