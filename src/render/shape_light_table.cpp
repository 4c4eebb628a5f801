// render/shape_light_table.cpp - lists emissive spheres, rectangles and disks for sampling.
// SPDX-License-Identifier: Apache-2.0
#include "render/shape_light_table.h"

#include "render/light_alphas.h"
#include "render/store_vector.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace obscura {

namespace {

Vec3d column(const Affined& map, int c) {
    return {map.m[0][c], map.m[1][c], map.m[2][c]};
}

/// Whether the three axes stay orthogonal and of equal length.
bool stays_round(const Affined& map) {
    const Vec3d axes[3] = {column(map, 0), column(map, 1), column(map, 2)};
    const double size = dot(axes[0], axes[0]);
    for (int i = 0; i < 3; ++i) {
        if (std::abs(dot(axes[i], axes[i]) - size) > 1e-5 * size) return false;
        if (std::abs(dot(axes[i], axes[(i + 1) % 3])) > 1e-5 * size) return false;
    }
    return true;
}

std::optional<ShapeLight> sphere_light(const ShapeRecord& record, const Affined& world) {
    if (!stays_round(world)) return std::nullopt;
    ShapeLight out;
    const Vec3d axes[3] = {column(world, 0), column(world, 1), column(world, 2)};
    store(normalize(axes[0]), out.x);
    store(normalize(axes[1]), out.y);
    store(normalize(axes[2]), out.z);
    const double radius = length(axes[0]) * static_cast<double>(record.size[0]);
    out.radius = static_cast<float>(radius);
    out.area = static_cast<float>(4 * pi_d * radius * radius);
    return out;
}

std::optional<ShapeLight> flat_light(const ShapeRecord& record, const Affined& world, bool disk) {
    if (is_unbounded(record) || (disk && record.size[1] > 0)) return std::nullopt;
    ShapeLight out;
    const Vec3d x = column(world, 0) * static_cast<double>(record.size[0]);
    const Vec3d z = column(world, 2) * static_cast<double>(record.size[disk ? 0 : 1]);
    const Vec3d upright = cross(z, x);
    const double squares = length(upright);
    const bool mirrored = dot(upright, column(world, 1)) < 0;
    store(x, out.x);
    store(z, out.z);
    store(normalize(mirrored ? -upright : upright), out.y);
    out.area = static_cast<float>((disk ? pi_d : 4.0) * squares);
    const bool square = std::abs(dot(x, z)) <= 1e-5 * length(x) * length(z);
    const auto kind = disk     ? ShapeLightKind::ellipse
                      : square ? ShapeLightKind::rectangle
                               : ShapeLightKind::parallelogram;
    out.kind = static_cast<int32_t>(kind);
    return out;
}

/// The light of one instance of a shape; nothing if it cannot be sampled.
std::optional<ShapeLight> light_of(const Scene& scene,
                                   const Primitive& primitive,
                                   const Affined& world) {
    const Material& material = scene.materials[static_cast<size_t>(primitive.material)];
    if (!emits(material)) return std::nullopt;
    if (primitive.geometry != static_cast<int32_t>(GeometryKind::shapes)) return std::nullopt;
    const ShapeRecord& record = scene.shapes[static_cast<size_t>(primitive.first_triangle)];
    std::optional<ShapeLight> light;
    switch (static_cast<ShapeKind>(record.kind)) {
        case ShapeKind::sphere:
            light = sphere_light(record, world);
            break;
        case ShapeKind::plane:
            light = flat_light(record, world, false);
            break;
        case ShapeKind::disk:
            light = flat_light(record, world, true);
            break;
        default:
            break;
    }
    if (!light || !(light->area > 0) || !std::isfinite(light->area)) return std::nullopt;
    const Vec3d centre{record.centre[0], record.centre[1], record.centre[2]};
    store(transform_point(world, centre), light->centre);
    std::copy_n(material.emission, 3, light->emission);
    light->coat = mean_coat(scene, material);
    light->texture = material.emissive_texture.texture;
    std::copy_n(material.emissive_texture.uv_from_mesh, 6, light->uv_from_shape);
    light->two_sided = glows_on_both_sides(material.flags) ? 1 : 0;
    return light;
}

/// Adds a light with its alpha, and returns its number; nothing where it is not sampled.
std::optional<int32_t> add_light(const Scene& scene,
                                 const Primitive& primitive,
                                 std::optional<ShapeLight> light,
                                 LightTable& table) {
    if (!light) return std::nullopt;
    const Material& material = scene.materials[static_cast<size_t>(primitive.material)];
    const bool sphere = light->kind == static_cast<int32_t>(ShapeLightKind::sphere);
    const auto alpha =
        has_alpha(material) ? shape_alpha(scene, material, sphere) : std::optional<LightAlpha>();
    if (alpha && sphere && light->two_sided != 0) return std::nullopt;
    if (alpha) {
        light->alpha = static_cast<int32_t>(table.alphas.size());
        table.alphas.push_back(*alpha);
    }
    table.shapes.push_back(*light);
    return static_cast<int32_t>(table.triangles.size() + table.shapes.size() - 1);
}

}  // namespace

void collect_shape_lights(Scene& scene, LightTable& table) {
    for (int32_t i = 0; i < scene.world_primitive_count; ++i) {
        Primitive& primitive = scene.primitives[static_cast<size_t>(i)];
        if (is_mesh(primitive)) continue;
        auto light = light_of(scene, primitive, {});
        if (is_catcher(scene, i, -1)) light.reset();
        primitive.light_base = add_light(scene, primitive, light, table).value_or(-1);
    }
    for (Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
        if (mesh.primitive_count != 1) continue;  // shapes have a mesh of their own
        Primitive& primitive = scene.primitives[static_cast<size_t>(mesh.first_primitive)];
        if (primitive.geometry != static_cast<int32_t>(GeometryKind::shapes)) continue;
        // Whether a shape can be sampled depends on its instance's transform.
        auto light = light_of(scene, primitive, affine_cast<double>(instance.world_from_object));
        primitive.light_base = 0;
        const auto number = static_cast<int32_t>(&instance - scene.instances.data());
        if (moves(instance) || is_catcher(scene, mesh.first_primitive, number)) light.reset();
        instance.light_base = add_light(scene, primitive, light, table).value_or(no_light_base);
    }
}

double shape_light_power(const LightTable& table, const ShapeLight& light) {
    const double sides = light.two_sided != 0 ? 2.0 : 1.0;
    const float most = std::max({light.emission[0], light.emission[1], light.emission[2]});
    return sides * pi_d * static_cast<double>(light.area) * static_cast<double>(most) *
           static_cast<double>(mean_alpha(table.alphas, light.alpha));
}

double brightest_shape_radiance(const Scene& scene) {
    double brightest = 0;
    for (const Primitive& primitive : scene.primitives) {
        if (is_mesh(primitive)) continue;
        const Material& material = scene.materials[static_cast<size_t>(primitive.material)];
        brightest = std::max(brightest, static_cast<double>(largest_emission(material)));
    }
    return brightest;
}

}  // namespace obscura
