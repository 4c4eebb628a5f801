// bench/standard_scenes.cpp - the scenes of `bench --standard`: a landscape, samples, a hall.
// SPDX-License-Identifier: Apache-2.0
#include "bench/standard_scenes.h"

#include "bench/standard_mesh.h"
#include "math/warp.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace obscura::bench {

namespace {

Material matt(float r, float g, float b, float roughness = 1) {
    Material out;
    out.base_color[0] = r;
    out.base_color[1] = g;
    out.base_color[2] = b;
    out.metallic = 0;
    out.roughness = roughness;
    return out;
}

Material glowing(float nits) {
    Material out = matt(0, 0, 0);
    for (float& channel : out.emission)
        channel = nits;
    return out;
}

/// A smooth wave pattern in [-1, 1] with details down to a few hundredths.
float waves(float x, float z) {
    float sum = 0;
    float size = 0.5f;
    float scale = 1;
    for (int octave = 0; octave < 5; ++octave) {
        sum += size * std::sin(scale * (1.7f * x + 0.6f * z) + 1.3f * static_cast<float>(octave)) *
               std::cos(scale * (1.1f * z - 0.8f * x) + 0.7f * static_cast<float>(octave));
        size *= 0.5f;
        scale *= 2.1f;
    }
    return sum;
}

/// The point of a height field; its normal from neighbouring heights.
template <typename Height>
SurfacePoint point_of_field(float x, float z, const Height& height) {
    constexpr float step = 1e-3f;
    const float y = height(x, z);
    const float dx = (height(x + step, z) - y) / step;
    const float dz = (height(x, z + step) - y) / step;
    return {{x, y, z}, normalize(Vec3f{-dx, 1, -dz})};
}

// ---- landscape: half a million triangles, and stones of 20,000 each in 2,000 places

float hill(float x, float z) {
    return 0.8f * waves(0.35f * x, 0.35f * z);
}

/// A ball with bumps.
SurfacePoint stone(float u, float v, uint32_t number) {
    const auto place = [&](float a, float b) {
        const Vec3f n = ball_direction(a, b);
        const auto shift = static_cast<float>(number);
        return n * (1 + 0.22f * waves(3 * n.x + shift, 3 * n.z + 2 * n.y));
    };
    constexpr float step = 1e-3f;
    const Vec3f p = place(u, v);
    const Vec3f along = place(u + step, v) - place(u - step, v);
    const Vec3f down = place(u, v + step) - place(u, v - step);
    const Vec3f side = cross(down, along);
    return {p, dot(side, side) > 1e-16f ? normalize(side) : normalize(p)};
}

Affinef placed(const Vec3f& at, float size, float turn) {
    Affinef out;
    const float c = size * std::cos(turn);
    const float s = size * std::sin(turn);
    out.m[0][0] = c;
    out.m[0][2] = s;
    out.m[1][1] = 0.7f * size;
    out.m[2][0] = -s;
    out.m[2][2] = c;
    out.m[0][3] = at.x;
    out.m[1][3] = at.y;
    out.m[2][3] = at.z;
    return out;
}

Scene make_landscape() {
    constexpr uint32_t stones = 2000;
    constexpr uint32_t kinds = 4;
    constexpr float side = 24;
    StandardMesh out;
    const int32_t soil = out.add(matt(0.32f, 0.26f, 0.18f));
    out.surface(512, 512, soil, [](float u, float v) {
        return point_of_field(side * (u - 0.5f), side * (v - 0.5f), hill);
    });
    for (uint32_t kind = 0; kind < kinds; ++kind) {
        const float grey = 0.25f + 0.1f * static_cast<float>(kind);
        const int32_t rock = out.add(matt(grey, 0.95f * grey, 0.9f * grey, 0.8f));
        const int32_t mesh = out.begin_mesh();
        out.surface(144, 72, rock, [kind](float u, float v) { return stone(u, v, kind); });
        for (uint32_t i = kind; i < stones; i += kinds) {
            const float x = side * (standard_random(i, 0) - 0.5f);
            const float z = side * (standard_random(i, 1) - 0.5f);
            const float size = 0.05f + 0.25f * std::pow(standard_random(i, 2), 3.0f);
            out.instance(mesh, placed({x, hill(x, z), z}, size, 2 * pi_f * standard_random(i, 3)));
        }
    }
    PunctualLight sun;
    sun.type = static_cast<int32_t>(PunctualType::directional);
    const Vec3f way = normalize(Vec3f{-0.5f, -0.6f, -0.4f});
    const float lux[3] = {9, 8, 6.5f};
    std::copy_n(&way.x, 3, sun.direction);
    std::copy_n(lux, 3, sun.intensity);
    out.scene().lights.push_back(sun);
    return out.take();
}

/// A sky: brighter towards the horizon.
LightingOptions sky() {
    ImageRgb32f image{64, 32, {}};
    for (int y = 0; y < image.height; ++y) {
        const float up = 1 - 2 * (static_cast<float>(y) + 0.5f) / static_cast<float>(image.height);
        const float light = up > 0 ? 1 - 0.6f * up : 0.15f;
        for (int x = 0; x < image.width; ++x)
            image.pixels.insert(image.pixels.end(), {0.7f * light, 0.85f * light, 1.1f * light});
    }
    LightingOptions out;
    out.environment = std::make_shared<const ImageRgb32f>(std::move(image));
    return out;
}

// ---- samples: balls of many materials and textures under soft boxes

uint32_t texel_of(float r, float g, float b) {
    const auto code = [](float value) {
        return static_cast<uint32_t>(std::lround(255 * std::clamp(value, 0.0f, 1.0f)));
    };
    return code(r) | code(g) << 8U | code(b) << 16U | 255U << 24U;
}

/// Tiles with joints: colour, roughness and metal, normals.
struct Tiles {
    int32_t color, rough, normal;
};

float joint(float u, float v) {
    const auto edge = [](float x) { return std::abs(x - std::floor(x) - 0.5f); };
    return std::max(edge(12 * u), edge(12 * v)) > 0.47f ? 1.0f : 0.0f;
}

Tiles add_tiles(StandardMesh& out) {
    constexpr int side = 1024;
    Tiles tiles;
    tiles.color = out.add_texture(side, true, [](float u, float v) {
        const float grain = 0.5f + 0.5f * waves(40 * u, 40 * v);
        const float dark = 1 - 0.6f * joint(u, v);
        return texel_of(dark * (0.5f + 0.4f * grain), dark * (0.4f + 0.3f * grain), dark * 0.35f);
    });
    tiles.rough = out.add_texture(side, false, [](float u, float v) {
        return texel_of(0, 0.3f + 0.3f * waves(25 * v, 25 * u) + 0.3f * joint(u, v), 0);
    });
    tiles.normal = out.add_texture(side, false, [](float u, float v) {
        const float x = 0.15f * waves(60 * u, 60 * v);
        const float y = 0.15f * waves(60 * v, 50 * u);
        const Vec3f n = normalize(Vec3f{x, y, 1});
        return texel_of(0.5f + 0.5f * n.x, 0.5f + 0.5f * n.y, 0.5f + 0.5f * n.z);
    });
    return tiles;
}

Material tiled(Material material, const Tiles& tiles, float repeats) {
    for (const auto& [slot, texture] :
         {std::pair{&material.base_color_texture, tiles.color},
          std::pair{&material.metallic_roughness_texture, tiles.rough},
          std::pair{&material.normal_texture, tiles.normal}}) {
        slot->texture = texture;
        slot->uv_from_mesh[0] = slot->uv_from_mesh[4] = repeats;
    }
    return material;
}

/// The material of ball number i of 15.
int32_t sample_material(int i, const Tiles& tiles, StandardMesh& out) {
    const float part = static_cast<float>(i % 5) / 4;
    Material base = matt(0.7f, 0.25f + 0.4f * part, 0.2f, 0.1f + 0.6f * part);
    MaterialLayers layers;
    if (i < 5) {
        base.metallic = 1;
        return out.add(i % 2 == 0 ? base : tiled(base, tiles, 2));
    }
    switch (i) {
        case 5:
            layers.clearcoat = 1;
            break;
        case 6:
            layers.sheen_color[0] = layers.sheen_color[1] = layers.sheen_color[2] = 0.8f;
            layers.sheen_roughness = 0.4f;
            break;
        case 7:
            layers.iridescence = 1;
            base.metallic = 1;
            break;
        case 8:
            layers.anisotropy = 0.8f;
            base.metallic = 1;
            break;
        case 9:
        case 10:
            layers.transmission = 1;
            layers.medium = 1;
            base = matt(1, 1, 1, i == 9 ? 0.0f : 0.3f);
            break;
        case 11:
            layers.diffuse_transmission = 0.7f;
            break;
        case 12:
            layers.clearcoat = 1;
            return out.add(tiled(base, tiles, 1), layers);
        default:
            return out.add(tiled(base, tiles, 1 + part));
    }
    return out.add(base, layers);
}

Scene make_samples() {
    StandardMesh out;
    Medium glass;
    glass.ior = 1.5f;
    out.scene().media.push_back(glass);
    const Tiles tiles = add_tiles(out);
    const int32_t floor = out.add(tiled(matt(1, 1, 1), tiles, 3));
    out.quad({-6, 0, 4}, {12, 0, 0}, {0, 0, -12}, floor);
    for (int i = 0; i < 15; ++i) {
        const auto x = static_cast<float>(i % 5 - 2);
        const int row = i / 5;
        const float z = 1.2f - 1.3f * static_cast<float>(row);
        out.sphere({1.15f * x, 0.5f, z}, 0.5f, 48, sample_material(i, tiles, out));
    }
    return out.take();
}

/// Dim surroundings with three soft boxes.
LightingOptions soft_boxes() {
    ImageRgb32f image{256, 128, {}};
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const bool is_high = y > 20 && y < 50;
            const bool is_box = is_high && x % 85 > 30 && x % 85 < 55;
            const float light = is_box ? 12.0f : 0.25f;
            const float warm = x < 85 ? 0.8f : 1.0f;
            image.pixels.insert(image.pixels.end(), {light, 0.95f * light, warm * light});
        }
    }
    LightingOptions out;
    out.environment = std::make_shared<const ImageRgb32f>(std::move(image));
    return out;
}

// ---- hall: columns between 96 glowing panels, 64 bulbs and 40 lamps without size

void add_lamps(StandardMesh& out) {
    const int32_t panel = out.add(glowing(40));
    const int32_t bulb = out.add(glowing(150));
    for (int i = 0; i < 96; ++i) {
        const auto x = static_cast<float>(i % 4) * 2 - 3.4f;
        const int row = i / 4;
        const float z = static_cast<float>(row) - 12;
        out.quad({x, 3.98f, z}, {0.6f, 0, 0}, {0, 0, 0.4f}, panel);
    }
    for (int i = 0; i < 64; ++i) {
        const float x = i % 2 == 0 ? -3.6f : 3.6f;
        out.sphere(
            {x, 1.5f + 0.8f * static_cast<float>(i % 3), 0.36f * static_cast<float>(i) - 11.6f},
            0.06f,
            8,
            bulb);
    }
    for (uint32_t i = 0; i < 40; ++i) {
        PunctualLight lamp;
        lamp.type = static_cast<int32_t>(PunctualType::point);
        const float place[3] = {7 * standard_random(i, 4) - 3.5f,
                                0.3f + 3 * standard_random(i, 5),
                                23 * standard_random(i, 6) - 11.5f};
        const float candela[3] = {2 * standard_random(i, 7), 1, 2 * standard_random(i, 8)};
        std::copy_n(place, 3, lamp.position);
        std::copy_n(candela, 3, lamp.intensity);
        out.scene().lights.push_back(lamp);
    }
}

Scene make_hall() {
    StandardMesh out;
    const int32_t wall = out.add(matt(0.75f, 0.72f, 0.68f));
    const int32_t ground = out.add(matt(0.3f, 0.22f, 0.15f, 0.35f));
    const int32_t column = out.add(matt(0.8f, 0.8f, 0.8f, 0.6f));
    out.quad({-4, 0, 12}, {8, 0, 0}, {0, 0, -24}, ground);
    out.quad({-4, 4, -12}, {8, 0, 0}, {0, 0, 24}, wall);
    out.quad({-4, 0, 12}, {0, 0, -24}, {0, 4, 0}, wall);
    out.quad({4, 0, -12}, {0, 0, 24}, {0, 4, 0}, wall);
    out.quad({-4, 0, -12}, {8, 0, 0}, {0, 4, 0}, wall);
    out.quad({4, 0, 12}, {-8, 0, 0}, {0, 4, 0}, wall);
    for (int i = 0; i < 20; ++i) {
        const float x = i % 2 == 0 ? -2.4f : 2.4f;
        const int pair = i / 2;
        const float z = 2.4f * static_cast<float>(pair) - 10.8f;
        out.surface(48, 32, column, [&](float u, float v) {
            const float radius = 0.28f + 0.03f * std::cos(12 * 2 * pi_f * u);
            const Vec3f way = {std::sin(2 * pi_f * u), 0, std::cos(2 * pi_f * u)};
            return SurfacePoint{Vec3f{x, 4 * (1 - v), z} + way * radius, way};
        });
        out.box({x - 0.4f, 0, z - 0.4f}, {x + 0.4f, 0.25f, z + 0.4f}, wall);
    }
    add_lamps(out);
    return out.take();
}

LightingOptions no_surroundings() {
    return {};
}

}  // namespace

const std::array<StandardScene, 3>& standard_scenes() {
    static const std::array<StandardScene, 3> all = {
        {{"landscape",
          "41 million triangles, most by instances, sun and sky",
          0.0013,
          0.672,
          make_landscape,
          sky,
          {7.5f, 2.6f, 9.5f},
          {0, 0, 0},
          38},
         {"samples",
          "15 materials with layers, glass and textures, soft boxes",
          0.04,
          0.461,
          make_samples,
          soft_boxes,
          {0, 2.9f, 6.2f},
          {0, 0.35f, -0.2f},
          32},
         {"hall",
          "an interior with 96 panels, 64 bulbs and 40 point lights",
          0.3,
          3.677,
          make_hall,
          no_surroundings,
          {0.6f, 1.7f, 11.2f},
          {0, 1.6f, 0},
          55}}};
    return all;
}

Camera camera_of(const StandardScene& scene, int width, int height) {
    const Vec3f back = normalize(scene.eye - scene.target);
    const Vec3f right = normalize(cross(Vec3f{0, 1, 0}, back));
    const Vec3f up = cross(back, right);
    Camera camera;
    const Vec3f columns[4] = {right, up, back, scene.eye};
    for (int c = 0; c < 4; ++c) {
        camera.world_from_camera.m[0][c] = columns[c].x;
        camera.world_from_camera.m[1][c] = columns[c].y;
        camera.world_from_camera.m[2][c] = columns[c].z;
    }
    const float half = 0.5f * scene.yfov_deg * static_cast<float>(radians_per_degree);
    camera.pinhole.tan_half_yfov = std::tan(half);
    camera.pinhole.aspect = static_cast<float>(width) / static_cast<float>(height);
    camera.pinhole.pixel_spread = 2 * camera.pinhole.tan_half_yfov / static_cast<float>(height);
    return camera;
}

}  // namespace obscura::bench
