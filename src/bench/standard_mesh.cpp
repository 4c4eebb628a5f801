// bench/standard_mesh.cpp - builds the geometry of the standard's scenes, surface by surface.
// SPDX-License-Identifier: Apache-2.0
#include "bench/standard_mesh.h"

#include "math/warp.h"
#include "scene/texture_arena.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace obscura::bench {

namespace {

/// Vertex v finds its attribute at base + components * v.
int32_t attribute_base(const Scene& scene, uint32_t first_vertex, int components) {
    return static_cast<int32_t>(static_cast<int64_t>(scene.attributes.size()) -
                                int64_t{components} * int64_t{first_vertex});
}

void grow(Bounds& bounds, const Vec3f& p) {
    bounds.low = {
        std::min(bounds.low.x, p.x), std::min(bounds.low.y, p.y), std::min(bounds.low.z, p.z)};
    bounds.high = max3(bounds.high, p);
}

/// Along u, at right angles to the normal.
Vec3f tangent_of(const Vec3f& along, const Vec3f& normal) {
    const Vec3f flat = along - normal * dot(along, normal);
    const float size = length(flat);
    if (size > 1e-6f) return flat * (1 / size);
    const Vec3f other = std::abs(normal.x) < 0.9f ? Vec3f{1, 0, 0} : Vec3f{0, 0, 1};
    return normalize(cross(normal, other));
}

}  // namespace

float standard_random(uint32_t index, uint32_t purpose) {
    // Source: Mueller's integer hash "lowbias32", by Wellons
    uint32_t x = index * 0x9E3779B9U + purpose * 0x85EBCA6BU + 1;
    x = (x ^ (x >> 16U)) * 0x7FEB352DU;
    x = (x ^ (x >> 15U)) * 0x846CA68BU;
    x ^= x >> 16U;
    return static_cast<float>(x >> 8U) * 0x1p-24f;
}

Vec3f ball_direction(float u, float v) {
    const float phi = 2 * pi_f * u;
    const float theta = pi_f * std::clamp(v, 0.0f, 1.0f);
    const float ring = v > 0 && v < 1 ? std::sin(theta) : 0.0f;
    return {ring * std::sin(phi), std::cos(theta), ring * std::cos(phi)};
}

int32_t StandardMesh::add(const Material& material) {
    scene_.materials.push_back(material);
    scene_.material_numbers.push_back(static_cast<int32_t>(scene_.material_numbers.size()));
    scene_.material_names.push_back("material " + std::to_string(scene_.materials.size()));
    return static_cast<int32_t>(scene_.materials.size()) - 1;
}

int32_t StandardMesh::add(Material material, const MaterialLayers& layers) {
    material.layers = static_cast<int32_t>(scene_.layers.size());
    scene_.layers.push_back(layers);
    return add(material);
}

int32_t StandardMesh::add_texture(int side,
                                  bool srgb,
                                  const std::function<uint32_t(float, float)>& texel) {
    TextureArena& arena = scene_.textures;
    const size_t start = arena.texels.size();
    arena.texels.resize(start + mip_chain_texels(side, side));
    uint32_t* const base = arena.texels.data() + start;
    const float step = 1.0f / static_cast<float>(side);
    for (int i = 0; i < side * side; ++i) {
        const int row = i / side;
        base[i] = texel((static_cast<float>(i % side) + 0.5f) * step,
                        (static_cast<float>(row) + 0.5f) * step);
    }
    build_mip_chain(base, side, side, srgb);
    TextureRecord record;
    record.width = record.height = side;
    record.levels = mip_level_count(side, side);
    record.sampler = pack_sampler(Wrap::repeat, Wrap::repeat, false, false, MipMode::linear, srgb);
    auto at = static_cast<int32_t>(start);
    for (int level = 0; level < record.levels; ++level) {
        record.level_offset[level] = at;
        at += (side >> level) * (side >> level);
    }
    arena.records.push_back(record);
    return static_cast<int32_t>(arena.records.size()) - 1;
}

void StandardMesh::surface(int columns,
                           int rows,
                           int32_t material,
                           const std::function<SurfacePoint(float, float)>& at) {
    const auto first = static_cast<uint32_t>(scene_.positions.size() / 3);
    Primitive primitive;
    primitive.first_triangle = static_cast<int32_t>(scene_.indices.size() / 3);
    primitive.material = material;
    primitive.node = static_cast<int32_t>(scene_.primitives.size());
    const std::vector<float> normals = add_vertices(columns, rows, at, primitive);
    const auto place = [&](uint32_t v) {
        const float* const p = &scene_.positions[3 * size_t{v}];
        return Vec3f{p[0], p[1], p[2]};
    };
    const auto triangle = [&](uint32_t a, uint32_t b, uint32_t c) {
        const Vec3f side = cross(place(b) - place(a), place(c) - place(a));
        if (dot(side, side) == 0) return;  // at poles
        const float* const n = &normals[3 * size_t{b - first}];
        const bool is_front = dot(side, Vec3f{n[0], n[1], n[2]}) > 0;
        scene_.indices.insert(scene_.indices.end(), {a, is_front ? b : c, is_front ? c : b});
    };
    const auto vertex = [&](int r, int c) {
        return first + static_cast<uint32_t>(r * (columns + 1) + c);
    };
    for (int r = 0; r < rows; ++r) {
        for (int c = 0; c < columns; ++c) {
            triangle(vertex(r, c), vertex(r, c + 1), vertex(r + 1, c + 1));
            triangle(vertex(r, c), vertex(r + 1, c + 1), vertex(r + 1, c));
        }
    }
    primitive.triangle_count =
        static_cast<int32_t>(scene_.indices.size() / 3) - primitive.first_triangle;
    scene_.primitives.push_back(primitive);
}

std::vector<float> StandardMesh::add_vertices(int columns,
                                              int rows,
                                              const std::function<SurfacePoint(float, float)>& at,
                                              Primitive& primitive) {
    const auto first = static_cast<uint32_t>(scene_.positions.size() / 3);
    std::vector<float> normals;
    std::vector<float> tangents;
    std::vector<float> uvs;
    const float du = 1.0f / static_cast<float>(columns);
    const float dv = 1.0f / static_cast<float>(rows);
    for (int r = 0; r <= rows; ++r) {
        for (int c = 0; c <= columns; ++c) {
            const float u = static_cast<float>(c) * du;
            const float v = static_cast<float>(r) * dv;
            const auto [p, n] = at(u, v);
            const Vec3f t = tangent_of(at(u + 0.01f * du, v).position - p, n);
            scene_.positions.insert(scene_.positions.end(), {p.x, p.y, p.z});
            normals.insert(normals.end(), {n.x, n.y, n.z});
            tangents.insert(tangents.end(), {t.x, t.y, t.z, 1});
            uvs.insert(uvs.end(), {u, v});
        }
    }
    const auto add = [&](const std::vector<float>& values, int components) {
        const int32_t base = attribute_base(scene_, first, components);
        scene_.attributes.insert(scene_.attributes.end(), values.begin(), values.end());
        return base;
    };
    primitive.normal_base = add(normals, 3);
    primitive.tangent_base = add(tangents, 4);
    primitive.uv_base[0] = add(uvs, 2);
    return normals;
}

void StandardMesh::quad(const Vec3f& p, const Vec3f& a, const Vec3f& b, int32_t material) {
    const Vec3f normal = normalize(cross(a, b));
    surface(1, 1, material, [&](float u, float v) {
        return SurfacePoint{p + a * u + b * v, normal};
    });
}

void StandardMesh::sphere(const Vec3f& centre, float radius, int rings, int32_t material) {
    surface(2 * rings, rings, material, [&](float u, float v) {
        const Vec3f n = ball_direction(u, v);
        return SurfacePoint{centre + n * radius, n};
    });
}

void StandardMesh::box(const Vec3f& low, const Vec3f& high, int32_t material) {
    const Vec3f size = high - low;
    const Vec3f x = {size.x, 0, 0};
    const Vec3f y = {0, size.y, 0};
    const Vec3f z = {0, 0, size.z};
    quad(low, y, x, material);
    quad(low, z, y, material);
    quad(low, x, z, material);
    quad(high - x - y, x, y, material);
    quad(high - y - z, y, z, material);
    quad(high - x - z, z, x, material);
}

int32_t StandardMesh::begin_mesh() {
    count_primitives();
    if (scene_.meshes.empty())
        scene_.world_primitive_count = static_cast<int32_t>(scene_.primitives.size());
    scene_.meshes.push_back(
        {static_cast<int32_t>(scene_.primitives.size()), 0, new_geometry_stamp()});
    return static_cast<int32_t>(scene_.meshes.size()) - 1;
}

void StandardMesh::instance(int32_t mesh, const Affinef& world_from_object) {
    Instance out;
    out.world_from_object = world_from_object;
    out.object_from_world = inverse(world_from_object);
    out.mesh = mesh;
    out.node = static_cast<int32_t>(scene_.primitives.size() + scene_.instances.size());
    scene_.instances.push_back(out);
}

void StandardMesh::count_primitives() {
    const auto count = static_cast<int32_t>(scene_.primitives.size());
    if (scene_.meshes.empty()) {
        scene_.world_primitive_count = count;
        return;
    }
    Mesh& latest = scene_.meshes.back();
    latest.primitive_count = count - latest.first_primitive;
    for (int32_t i = latest.first_primitive; i < count; ++i)
        scene_.primitives[static_cast<size_t>(i)].node = -1;
}

Scene StandardMesh::take() {
    count_primitives();
    const auto place = [&](uint32_t v) {
        const float* const p = &scene_.positions[3 * size_t{v}];
        return Vec3f{p[0], p[1], p[2]};
    };
    const auto each_vertex = [&](const Primitive& primitive, const auto& use) {
        const size_t begin = size_t{3} * static_cast<size_t>(primitive.first_triangle);
        const size_t end = begin + size_t{3} * static_cast<size_t>(primitive.triangle_count);
        for (size_t i = begin; i < end; ++i)
            use(place(scene_.indices[i]));
    };
    for (int32_t i = 0; i < scene_.world_primitive_count; ++i) {
        each_vertex(scene_.primitives[static_cast<size_t>(i)],
                    [&](const Vec3f& p) { grow(scene_.bounds, p); });
    }
    for (const Instance& instance : scene_.instances) {
        const Mesh& mesh = scene_.meshes[static_cast<size_t>(instance.mesh)];
        for (int32_t i = 0; i < mesh.primitive_count; ++i) {
            const int32_t index = mesh.first_primitive + i;
            each_vertex(scene_.primitives[static_cast<size_t>(index)], [&](const Vec3f& p) {
                grow(scene_.bounds, transform_point(instance.world_from_object, p));
            });
        }
    }
    pad_tables(scene_);
    return std::move(scene_);
}

}  // namespace obscura::bench
