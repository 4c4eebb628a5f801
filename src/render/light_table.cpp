// render/light_table.cpp - lists all lights of a scene, with their sampling probabilities.
// SPDX-License-Identifier: Apache-2.0
#include "render/light_table.h"

#include "base/parallel.h"
#include "math/warp.h"
#include "render/light_alphas.h"
#include "render/light_bounds.h"
#include "render/shape_light_table.h"
#include "surface/texture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace obscura {

namespace {

double scene_radius(const Bounds& bounds) {
    if (bounds.empty()) return 1.0;
    const Vec3f size = bounds.high - bounds.low;
    return std::max(0.5 * static_cast<double>(length(size)), 1e-6);
}

double punctual_power(const Scene& scene, const PunctualLight& light, double radius) {
    const double intensity = static_cast<double>(
        luminance(Vec3f{light.intensity[0], light.intensity[1], light.intensity[2]}));
    const bool directional = light.type == static_cast<int32_t>(PunctualType::directional);
    if (light.profile >= 0) {
        return intensity * profile_lumens(scene.light_profiles[static_cast<size_t>(light.profile)]);
    }
    return directional ? pi_d * radius * radius * intensity : 4.0 * pi_d * intensity;
}

/// Data that the lights of one emissive primitive share.
struct Emitter {
    const Scene& scene;
    const Primitive& primitive;
    const Material& material;
    const Instance* instance;
};

/// The vertices of a triangle, in the order of its record: a mirroring instance turns it round.
std::array<uint32_t, 3> corners_of(const Emitter& e, int32_t triangle) {
    const uint32_t* corners =
        &e.scene.indices[3 * static_cast<size_t>(e.primitive.first_triangle + triangle)];
    const bool mirrored = e.instance != nullptr && e.instance->mirrored != 0;
    return {corners[0], corners[mirrored ? 2 : 1], corners[mirrored ? 1 : 2]};
}

/// Mean emission of a triangle's texture, by a small grid of look-ups at a fitting mip level.
Vec3f mean_texture(const Scene& scene, const TriangleLight& record) {
    const TextureView view = view_of(scene.textures);
    constexpr int side = 4;
    const float area =
        0.5f * std::fabs((record.uv1[0] - record.uv0[0]) * (record.uv2[1] - record.uv0[1]) -
                         (record.uv1[1] - record.uv0[1]) * (record.uv2[0] - record.uv0[0]));
    Vec3f sum{0, 0, 0};
    for (int i = 0; i < side * side; ++i) {
        const int row_of_cell = i / side;
        const Vec2f u{(static_cast<float>(i % side) + 0.5f) / side,
                      (static_cast<float>(row_of_cell) + 0.5f) / side};
        const Vec2f b = triangle_from_square(u);
        const Vec2f uv{record.uv0[0] + (record.uv1[0] - record.uv0[0]) * b.x +
                           (record.uv2[0] - record.uv0[0]) * b.y,
                       record.uv0[1] + (record.uv1[1] - record.uv0[1]) * b.x +
                           (record.uv2[1] - record.uv0[1]) * b.y};
        sum = sum +
              sample_texture_bilinear<float>(view, record.texture, uv, area / (side * side)).rgb;
    }
    return sum * (1.0f / (side * side));
}

TriangleLight light_record(const Emitter& e, int32_t triangle) {
    const std::array<uint32_t, 3> corners = corners_of(e, triangle);
    Vec3f p[3];
    for (size_t k = 0; k < 3; ++k) {
        const float* at = &e.scene.positions[3 * static_cast<size_t>(corners[k])];
        p[k] = {at[0], at[1], at[2]};
        if (e.instance != nullptr) p[k] = transform_point(e.instance->world_from_object, p[k]);
    }
    TriangleLight record = make_triangle_light(p[0], p[1], p[2]);
    std::copy_n(e.material.emission, 3, record.emission);
    record.coat = mean_coat(e.scene, e.material);
    record.two_sided = glows_on_both_sides(e.material.flags) ? 1 : 0;
    const TextureSlot& slot = e.material.emissive_texture;
    const bool has_uv = e.primitive.uv_base[slot.uv_set] != no_attribute;
    record.texture = has_uv ? slot.texture : -1;
    if (record.texture >= 0) {
        float* const uv[3] = {record.uv0, record.uv1, record.uv2};
        for (size_t k = 0; k < 3; ++k) {
            const Vec2f corner = texture_corner(e.scene, e.primitive, slot, corners[k]);
            std::copy_n(&corner.x, 2, uv[k]);
        }
    }
    return record;
}

/// least: added to the texture's mean, so that black textures keep some weight.
Vec3f emission_of(const Scene& scene, const TriangleLight& record, float least) {
    const Vec3f emission{record.emission[0], record.emission[1], record.emission[2]};
    const Vec3f below = emission * (1 - record.coat * mean_coat_reflectance);
    return record.texture < 0 ? below : below * (mean_texture(scene, record) + splat3(least));
}

double triangle_power(const Scene& scene,
                      const LightTable& table,
                      const TriangleLight& record,
                      float least) {
    const Vec3f emission =
        emission_of(scene, record, least) * mean_alpha(table.alphas, record.alpha);
    const double sides = record.two_sided != 0 ? 2.0 : 1.0;
    return sides * pi_d * static_cast<double>(record.area) *
           static_cast<double>(max_component(emission));
}

/// A corner at one of Motion's times. Primitive or instance moves, not both: see is_sampled.
Vec3f corner_at(const Emitter& e, uint32_t vertex, int32_t step) {
    const Scene& scene = e.scene;
    const float* p = &scene.positions[3 * static_cast<size_t>(vertex)];
    if (moves(e.primitive)) {
        const int64_t word = static_cast<int64_t>(e.primitive.motion_base) +
                             static_cast<int64_t>(step) * e.primitive.motion_stride +
                             static_cast<int64_t>(vertex) * 3;
        p = &scene.motion.positions[static_cast<size_t>(word)];
    }
    const Vec3f at{p[0], p[1], p[2]};
    if (e.instance == nullptr) return at;
    if (!moves(*e.instance)) return transform_point(e.instance->world_from_object, at);
    const auto index = static_cast<size_t>(e.instance->motion) + static_cast<size_t>(step);
    return transform_point(scene.motion.instances[index], at);
}

void store(const Vec3f& v, float* out) {
    out[0] = v.x;
    out[1] = v.y;
    out[2] = v.z;
}

/// Position of a triangle of the table, with its corners in the record's order.
MovingTriangle triangle_at(const Emitter& e, int32_t triangle, int32_t step) {
    const std::array<uint32_t, 3> corners = corners_of(e, triangle);
    const Vec3f p0 = corner_at(e, corners[0], step);
    MovingTriangle out;
    store(p0, out.p0);
    store(corner_at(e, corners[1], step) - p0, out.e1);
    store(corner_at(e, corners[2], step) - p0, out.e2);
    return out;
}

/// False for shadow catchers, and for a mesh that deforms while its instance moves: its vertices do
/// not move linearly between two times, so that only BSDF sampling finds it.
bool is_sampled(const Emitter& e) {
    const auto primitive = static_cast<int32_t>(&e.primitive - e.scene.primitives.data());
    const auto instance =
        e.instance == nullptr ? -1 : static_cast<int32_t>(e.instance - e.scene.instances.data());
    if (is_catcher(e.scene, primitive, instance)) return false;
    return e.instance == nullptr || !moves(*e.instance) || !moves(e.primitive);
}

/// Appends the alpha of an emitter's triangles, from number `first` of the lights on.
void append_alphas(const Emitter& e, size_t first, LightTable& table) {
    if (!has_alpha(e.material)) return;
    const auto count = static_cast<size_t>(e.primitive.triangle_count);
    std::vector<std::optional<LightAlpha>> alphas(count);
    parallel_ranges(count, 64, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i)
            alphas[i] =
                triangle_alpha(e.scene, e.primitive, corners_of(e, static_cast<int32_t>(i)));
    });
    for (size_t i = 0; i < count; ++i) {
        if (!alphas[i]) continue;
        table.triangles[first + i].alpha = static_cast<int32_t>(table.alphas.size());
        table.alphas.push_back(*alphas[i]);
    }
}

/// Appends the lights of one instance of a primitive; those that are not sampled have no area.
void append_records(const Emitter& e, LightTable& table) {
    const auto count = static_cast<size_t>(e.primitive.triangle_count);
    const size_t first = table.triangles.size();
    table.triangles.resize(first + count);
    if (!is_sampled(e)) return;
    const bool is_moving = moves(e.primitive) || (e.instance != nullptr && moves(*e.instance));
    const auto steps = static_cast<size_t>(e.scene.motion.steps);
    const size_t first_moving = table.moving_triangles.size();
    if (is_moving) table.moving_triangles.resize(first_moving + count * steps);
    parallel_ranges(count, 1024, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            TriangleLight& record = table.triangles[first + i];
            record = light_record(e, static_cast<int32_t>(i));
            if (!is_moving) continue;
            const size_t at = first_moving + i * steps;
            record.motion = static_cast<int32_t>(at);
            for (size_t step = 0; step < steps; ++step) {
                table.moving_triangles[at + step] =
                    triangle_at(e, static_cast<int32_t>(i), static_cast<int32_t>(step));
            }
        }
    });
    append_alphas(e, first, table);
}

void collect_world_emitters(Scene& scene, LightTable& table) {
    for (int32_t i = 0; i < scene.world_primitive_count; ++i) {
        Primitive& primitive = scene.primitives[static_cast<size_t>(i)];
        const Material& material = scene.materials[static_cast<size_t>(primitive.material)];
        if (!emits(material) || !is_mesh(primitive)) continue;
        primitive.light_base = static_cast<int32_t>(table.triangles.size());
        append_records({scene, primitive, material, nullptr}, table);
    }
}

/// Numbers emissive primitives within their mesh; Instance::light_base is added to that.
void collect_instance_emitters(Scene& scene, LightTable& table) {
    for (const Mesh& mesh : scene.meshes) {
        int32_t within = 0;
        const int32_t end = mesh.first_primitive + mesh.primitive_count;
        for (int32_t i = mesh.first_primitive; i < end; ++i) {
            Primitive& primitive = scene.primitives[static_cast<size_t>(i)];
            const bool glows = is_mesh(primitive) &&
                               emits(scene.materials[static_cast<size_t>(primitive.material)]);
            primitive.light_base = glows ? within : -1;
            within += glows ? primitive.triangle_count : 0;
        }
    }
    for (Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
        instance.light_base = static_cast<int32_t>(table.triangles.size());
        const int32_t end = mesh.first_primitive + mesh.primitive_count;
        for (int32_t i = mesh.first_primitive; i < end; ++i) {
            const Primitive& primitive = scene.primitives[static_cast<size_t>(i)];
            if (primitive.light_base < 0 || !is_mesh(primitive)) continue;
            const Material& material = scene.materials[static_cast<size_t>(primitive.material)];
            append_records({scene, primitive, material, &instance}, table);
        }
    }
}

/// Weights by power, with a minimum for each kind of light that is present. Power does not tell how
/// near a light is: under a bright sky, a dim lamp still lights its corner.
std::vector<double> choice_weights(const std::vector<double>& punctual,
                                   const std::vector<double>& triangles,
                                   double environment) {
    const auto sum = [](const std::vector<double>& v) {
        double total = 0;
        for (const double x : v)
            total += x;
        return total;
    };
    const double kinds[3] = {sum(punctual), sum(triangles), environment};
    const double total = kinds[0] + kinds[1] + kinds[2];
    double scale[3] = {0, 0, 0};
    for (int k = 0; k < 3; ++k) {
        const double fraction = kinds[k] / total;
        // Near lights of faint kinds are also found by BSDF sampling, except punctual ones.
        const double least = k == 0 ? 0.2 : std::min(0.2, 50.0 * fraction);
        if (kinds[k] > 0) scale[k] = std::max(fraction, least) / kinds[k];
    }
    std::vector<double> weights;
    weights.reserve(punctual.size() + triangles.size() + 1);
    for (const double w : punctual)
        weights.push_back(w * scale[0]);
    for (const double w : triangles)
        weights.push_back(w * scale[1]);
    if (environment > 0) weights.push_back(environment * scale[2]);
    return weights;
}

/// The weight of all lights of a tree, which becomes the tree's in the table.
double take_weight(std::span<const BoundedLight> in_tree, std::vector<double>& weights) {
    double sum = 0;
    for (const BoundedLight& light : in_tree) {
        double& weight = weights[static_cast<size_t>(light.light)];
        sum += weight;
        weight = 0;
    }
    return sum;
}

/// Writes the probabilities of choosing each light to where light sampling reads them.
void set_probabilities(const std::vector<double>& pdf, LightTable& table) {
    table.select_pdf.assign(pdf.begin(), pdf.end());
    const size_t first_triangle = table.punctual.size();
    for (size_t i = 0; i < table.triangles.size(); ++i) {
        TriangleLight& record = table.triangles[i];
        const double area = static_cast<double>(record.area);
        record.pdf_area = area > 0 ? static_cast<float>(pdf[first_triangle + i] / area) : 0.0f;
    }
    const size_t first_shape = first_triangle + table.triangles.size();
    for (size_t i = 0; i < table.shapes.size(); ++i)
        table.shapes[i].select = static_cast<float>(pdf[first_shape + i]);
}

}  // namespace

float largest_emission(const Material& material) {
    return std::max({material.emission[0], material.emission[1], material.emission[2]});
}

bool is_catcher(const Scene& scene, int32_t primitive, int32_t instance) {
    return (scene.visibility.of(primitive, instance) & visibility_catcher) != 0;
}

bool emits(const Material& material) {
    return (material.flags & material_unlit) == 0 && largest_emission(material) > 0;
}

LightTable make_light_table(Scene& scene, const EnvironmentTable* environment) {
    LightTable table;
    table.punctual = scene.lights;
    table.profiles = pack_light_profiles(scene.light_profiles);
    if (!scene.motion.lights.empty()) table.moving_punctual = scene.motion.lights.data();
    collect_world_emitters(scene, table);
    collect_instance_emitters(scene, table);
    collect_shape_lights(scene, table);

    const double radius = scene_radius(scene.bounds);
    std::vector<double> punctual;
    for (const PunctualLight& light : table.punctual) {
        punctual.push_back(punctual_power(scene, light, radius));
    }
    std::vector<double> triangles(table.triangles.size());
    parallel_ranges(triangles.size(), 1024, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            // A dark texel grid must not hide a bright spot: every triangle keeps a little.
            triangles[i] = triangle_power(scene, table, table.triangles[i], 1e-3f);
        }
    });
    for (const ShapeLight& light : table.shapes)
        triangles.push_back(shape_light_power(table, light));
    const bool has_environment = environment != nullptr && !environment->black();
    const double environment_power =
        has_environment ? pi_d * radius * radius * environment->power_to_sample() : 0.0;
    std::vector<double> weights = choice_weights(punctual, triangles, environment_power);
    if (weights.empty()) return table;

    std::vector<double> powers = std::move(punctual);
    powers.insert(powers.end(), triangles.begin(), triangles.end());
    const std::vector<BoundedLight> in_tree = bounded_lights(table, powers, scene);
    const size_t count = weights.size();
    if (!in_tree.empty()) weights.push_back(take_weight(in_tree, weights));
    table.choice = build_cdf_table(std::span<const double>(weights));
    std::vector<double> pdf = cdf_probabilities(table.choice);
    if (has_environment) {
        table.environment_select = static_cast<float>(pdf[count - 1]);
        table.environment_spread = cdf_spread(std::span<const CdfEntry>(table.choice), count - 1);
    }
    if (!in_tree.empty()) {
        table.tree = build_light_tree(in_tree, count);
        table.tree_share = static_cast<float>(pdf.back());
        pdf.pop_back();
        for (const BoundedLight& light : in_tree)
            pdf[static_cast<size_t>(light.light)] = 1;  // what is left to choose, the tree chooses
    }
    set_probabilities(pdf, table);
    return table;
}

float mean_coat(const Scene& scene, const Material& material) {
    if (material.layers < 0) return 0;
    const MaterialLayers& layers = scene.layers[static_cast<size_t>(material.layers)];
    const int32_t texture = layers.clearcoat_texture.texture;
    if (texture < 0 || !(layers.clearcoat > 0)) return layers.clearcoat;
    const TextureRecord& record = scene.textures.records[static_cast<size_t>(texture)];
    // The last texel is the mean if the mip chain goes down to one texel.
    const auto last = static_cast<size_t>(record.level_offset[record.levels - 1]);
    return layers.clearcoat * texel_channel(scene.textures, record, last, 0);
}

Vec3f mean_emission(const Scene& scene, const LightTable& table, const TriangleLight& record) {
    return emission_of(scene, record, 0.0f) * mean_alpha(table.alphas, record.alpha);
}

double brightest_mean_radiance(const Scene& scene, const LightTable& table) {
    const auto same_surface = [](const TriangleLight& a, const TriangleLight& b) {
        return a.texture == b.texture && a.two_sided == b.two_sided &&
               std::equal(a.emission, a.emission + 3, b.emission);
    };
    double brightest = 0;
    double power = 0;
    double area = 0;
    for (size_t i = 0; i < table.triangles.size(); ++i) {
        const TriangleLight& record = table.triangles[i];
        if (i > 0 && !same_surface(record, table.triangles[i - 1])) power = area = 0;
        power += triangle_power(scene, table, record, 0.0f);
        area += (record.two_sided != 0 ? 2.0 : 1.0) * static_cast<double>(record.area);
        const bool is_last =
            i + 1 == table.triangles.size() || !same_surface(record, table.triangles[i + 1]);
        if (is_last && area > 0) brightest = std::max(brightest, power / (pi_d * area));
    }
    return brightest;
}

LightView LightTable::view() const {
    return {choice.data(),
            select_pdf.data(),
            static_cast<int32_t>(select_pdf.size()),
            static_cast<int32_t>(punctual.size()),
            static_cast<int32_t>(triangles.size()),
            punctual.data(),
            triangles.data(),
            static_cast<int32_t>(shapes.size()),
            shapes.data(),
            environment_select,
            environment_spread,
            profiles.view(),
            moving_punctual,
            moving_triangles.empty() ? nullptr : moving_triangles.data(),
            alphas.empty() ? nullptr : alphas.data(),
            tree_view()};
}

LightTreeView LightTable::tree_view() const {
    if (tree.nodes.empty()) return {};
    const uint32_t first = choice[select_pdf.size()].first_random;
    return {tree.nodes.data(),
            tree.light_of_leaf.data(),
            tree.leaf_of_light.data(),
            static_cast<int32_t>(tree.light_of_leaf.size()),
            static_cast<int32_t>(first >> 2U),
            static_cast<int32_t>((1U << 30U) - (first >> 2U)),
            tree_share};
}

}  // namespace obscura
