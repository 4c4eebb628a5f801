// render/light_bounds.cpp - what the light tree knows of each light, and which scenes have a tree.
// SPDX-License-Identifier: Apache-2.0
#include "render/light_bounds.h"

#include "math/warp.h"
#include "scene/thin_walls.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace obscura {

namespace {

Vec3f vector_of(const float* at) {
    return {at[0], at[1], at[2]};
}

/// A light within a box; elsewhere the defaults: it shines in all directions.
BoundedLight light_in(const Vec3f& low, const Vec3f& high, double intensity) {
    BoundedLight out;
    out.low = low;
    out.high = high;
    const Vec3f centre = (low + high) * 0.5f;
    std::copy_n(&centre.x, 3, out.bounds.centre);
    out.bounds.radius = 0.5f * length(high - low);
    out.bounds.intensity = static_cast<float>(intensity);
    return out;
}

void set_normal(const Vec3f& normal, bool two_sided, LightBounds& bounds) {
    std::copy_n(&normal.x, 3, bounds.axis);
    bounds.cos_normals = 1;
    bounds.sin_normals = 0;
    bounds.cos_emission = 0;
    bounds.sides = two_sided ? 1 : 0;
}

/// Nothing for directional lights, which have no place.
std::optional<BoundedLight> bounded(const PunctualLight& light, double power) {
    if (light.type == static_cast<int32_t>(PunctualType::directional)) return std::nullopt;
    const Vec3f place = vector_of(light.position);
    const Vec3f color = vector_of(light.intensity);
    // Its power counts luminance, that of emissive surfaces the brightest channel.
    const double brightest = static_cast<double>(max_component(color) / luminance(color));
    BoundedLight out = light_in(place, place, power * brightest / (4 * pi_d));
    const bool spot = light.type == static_cast<int32_t>(PunctualType::spot);
    if (!spot || light.profile >= 0 || !(light.spot_scale > 0)) return out;
    set_normal(vector_of(light.direction), false, out.bounds);
    out.bounds.cos_emission = std::clamp(1 - light.spot_on_axis / light.spot_scale, -1.0f, 1.0f);
    return out;
}

std::optional<BoundedLight> bounded(const TriangleLight& light, double power) {
    const Vec3f p0 = vector_of(light.p0);
    const Vec3f p1 = p0 + vector_of(light.e1);
    const Vec3f p2 = p0 + vector_of(light.e2);
    const double sides = light.two_sided != 0 ? 2 : 1;
    BoundedLight out =
        light_in(-max3(-p0, max3(-p1, -p2)), max3(p0, max3(p1, p2)), power / (sides * pi_d));
    // Divided by the area first: the square of a tiny triangle's cross product would underflow.
    const Vec3f normal = cross(vector_of(light.e1), vector_of(light.e2) * (0.5f / light.area));
    if (!(dot(normal, normal) > 0)) return out;
    set_normal(normalize(normal), light.two_sided != 0, out.bounds);
    return out;
}

std::optional<BoundedLight> bounded(const ShapeLight& light, double power) {
    const Vec3f centre = vector_of(light.centre);
    const double sides = light.two_sided != 0 ? 2 : 1;
    const double radiance_area = power / (sides * pi_d);
    if (light.kind == static_cast<int32_t>(ShapeLightKind::sphere)) {
        const Vec3f half{light.radius, light.radius, light.radius};
        BoundedLight out = light_in(centre - half, centre + half, radiance_area / 4);
        out.bounds.radius = light.radius;
        return out;
    }
    const Vec3f half = abs(vector_of(light.x)) + abs(vector_of(light.z));
    BoundedLight out = light_in(centre - half, centre + half, radiance_area);
    set_normal(vector_of(light.y), light.two_sided != 0, out.bounds);
    return out;
}

/// A light that moves, over all of its way: between two times, its position is in the box around
/// those of both. How it turns is not bounded.
BoundedLight on_its_way(const BoundedLight& still, std::span<const Vec3f> places) {
    Vec3f low = places[0];
    Vec3f high = places[0];
    for (const Vec3f& place : places) {
        low = -max3(-low, -place);
        high = max3(high, place);
    }
    return light_in(low, high, static_cast<double>(still.bounds.intensity));
}

/// Its places at all times; none if it stands still.
std::vector<Vec3f> way_of(const LightTable& table, int32_t steps, const PunctualLight& light) {
    std::vector<Vec3f> places;
    if (table.moving_punctual == nullptr) return places;
    const auto number = static_cast<size_t>(&light - table.punctual.data());
    const auto times = static_cast<size_t>(steps);
    for (size_t step = 0; step < times; ++step)
        places.push_back(vector_of(table.moving_punctual[number * times + step].position));
    return places;
}

std::vector<Vec3f> way_of(const LightTable& table, int32_t steps, const TriangleLight& light) {
    std::vector<Vec3f> places;
    if (light.motion < 0) return places;
    const auto first = static_cast<size_t>(light.motion);
    for (size_t step = 0; step < static_cast<size_t>(steps); ++step) {
        const MovingTriangle& at = table.moving_triangles[first + step];
        const Vec3f p0 = vector_of(at.p0);
        places.insert(places.end(), {p0, p0 + vector_of(at.e1), p0 + vector_of(at.e2)});
    }
    return places;
}

std::vector<Vec3f> way_of(const LightTable&, int32_t, const ShapeLight&) {
    return {};
}

}  // namespace

std::vector<BoundedLight> bounded_lights(const LightTable& table,
                                         std::span<const double> power,
                                         const Scene& scene) {
    const int32_t steps = scene.motion.steps;
    std::vector<BoundedLight> out;
    size_t number = 0;
    const auto add = [&](const auto& light) {
        const double own = power[number];
        const bool shines = own > 0 && std::isfinite(own);
        if (auto found = shines ? bounded(light, own) : std::nullopt) {
            const std::vector<Vec3f> way = way_of(table, steps, light);
            if (!way.empty()) found = on_its_way(*found, way);
            found->light = static_cast<int32_t>(number);
            out.push_back(*found);
        }
        ++number;
    };
    std::for_each(table.punctual.begin(), table.punctual.end(), add);
    std::for_each(table.triangles.begin(), table.triangles.end(), add);
    std::for_each(table.shapes.begin(), table.shapes.end(), add);
    if (out.size() < min_tree_lights) out.clear();
    const auto is_punctual = [&](const BoundedLight& light) {
        return light.light < static_cast<int32_t>(table.punctual.size());
    };
    const bool is_apart = std::count_if(out.begin(), out.end(), is_punctual) <= max_points_apart &&
                          has_passable_boundaries(scene);
    if (is_apart) std::erase_if(out, is_punctual);
    return out;
}

}  // namespace obscura
