// render/raycast_lights.cpp - for raycast: area lights as points, the environment as irradiance.
// SPDX-License-Identifier: Apache-2.0
#include "render/raycast_lights.h"

#include "base/parallel.h"
#include "render/light_alphas.h"
#include "render/store_vector.h"
#include "surface/texture.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace obscura {

namespace {

/// The range of the triangle light table that belongs to one instance of a primitive.
struct EmitterRange {
    size_t first = 0, count = 0;
};

std::vector<EmitterRange> list_emitters(const Scene& scene) {
    std::vector<EmitterRange> list;
    const auto add = [&](const Primitive& primitive, int32_t base) {
        if (primitive.light_base < 0 || base < 0 || !is_mesh(primitive)) return;
        list.push_back({static_cast<size_t>(base + primitive.light_base),
                        static_cast<size_t>(primitive.triangle_count)});
    };
    for (int32_t i = 0; i < scene.world_primitive_count; ++i)
        add(scene.primitives[static_cast<size_t>(i)], 0);
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
        const int32_t end = mesh.first_primitive + mesh.primitive_count;
        for (int32_t i = mesh.first_primitive; i < end; ++i)
            add(scene.primitives[static_cast<size_t>(i)], instance.light_base);
    }
    return list;
}

Vec3d vector(const float* v) {
    return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

/// Triangles whose normals stay within about 8 degrees of their mean count as one flat lamp.
constexpr double flat_fraction = 0.99;

CentreLight centre_of(const PreparedScene::Impl& impl, const EmitterRange& emitter) {
    const TriangleLight* const lights = impl.lights.triangles.data() + emitter.first;
    Vec3d flux = splat3(0.0);        // radiance times area
    Vec3d centre_sum = splat3(0.0);  // of triangle centres times their weights
    Vec3d normal = splat3(0.0);
    double weights = 0;
    double area = 0;
    const auto for_each = [&](const auto& use) {
        for (size_t i = 0; i < emitter.count; ++i)
            use(lights[i], vector(lights[i].p0), vector(lights[i].e1), vector(lights[i].e2));
    };
    for_each([&](const TriangleLight& light, const Vec3d& p0, const Vec3d& e1, const Vec3d& e2) {
        const Vec3f mean = mean_emission(impl.scene, impl.lights, light);
        const Vec3d emission{mean.x, mean.y, mean.z};
        const Vec3d face = cross(e1, e2) * 0.5;
        const double weight = max_component(emission);
        flux = flux + emission * length(face);
        centre_sum = centre_sum + (p0 + (e1 + e2) * (1.0 / 3.0)) * (weight * length(face));
        normal = normal + face * weight;
        weights += weight * length(face);
        area += weight > 0 ? length(face) : 0;
    });
    CentreLight out;
    if (!(weights > 0)) return out;
    const Vec3d centre = centre_sum * (1.0 / weights);
    double radius = 0;
    for_each([&](const TriangleLight&, const Vec3d& p0, const Vec3d& e1, const Vec3d& e2) {
        for (const Vec3d& corner : {p0, p0 + e1, p0 + e2})
            radius = std::max(radius, length(corner - centre));
    });
    out.flat = length(normal) >= flat_fraction * weights ? 1 : 0;
    const double share = out.flat != 0 ? 1.0 : 0.25;
    store(centre, out.position);
    store(normalize(normal), out.normal);
    store(flux * share, out.intensity);
    out.min_distance_squared = static_cast<float>(area * share / pi_d);
    // Shadow rays must not hit the lamp: for flat ones a margin for rounding suffices.
    const double slack = 1e-5 * (length(centre) + radius);
    out.radius = static_cast<float>(out.flat != 0 ? 1e-3 * radius + slack : radius + slack);
    out.two_sided = lights[0].two_sided;
    return out;
}

/// Mean over a shape light's surface of what it sends out, before its alpha.
Vec3d mean_shape_emission(const Scene& scene, const ShapeLight& light) {
    const double below_coat = 1 - static_cast<double>(light.coat * mean_coat_reflectance);
    const Vec3d emission = vector(light.emission) * below_coat;
    if (light.texture < 0) return emission;
    const TextureView view = view_of(scene.textures);
    const bool sphere = light.kind == static_cast<int32_t>(ShapeLightKind::sphere);
    constexpr int side = 16;
    Vec3d sum = splat3(0.0);
    double weights = 0;
    const float* m = light.uv_from_shape;
    for (int i = 0; i < side * side; ++i) {
        const int row = i / side;
        const float u = (static_cast<float>(i % side) + 0.5f) / side;
        const float v = (static_cast<float>(row) + 0.5f) / side;
        const Vec2f uv{m[0] * u + m[1] * v + m[2], m[3] * u + m[4] * v + m[5]};
        const Vec3f texel =
            sample_texture_bilinear<float>(view, light.texture, uv, 1.0f / (side * side)).rgb;
        const double weight = sphere ? std::sin(pi_d * static_cast<double>(v)) : 1.0;
        sum = sum + Vec3d{texel.x, texel.y, texel.z} * weight;
        weights += weight;
    }
    return emission * sum * (1.0 / weights);
}

CentreLight centre_of(const PreparedScene::Impl& impl, const ShapeLight& light) {
    CentreLight out;
    const bool sphere = light.kind == static_cast<int32_t>(ShapeLightKind::sphere);
    const double area = static_cast<double>(light.area) * (sphere ? 0.25 : 1.0);
    const double size = sphere ? static_cast<double>(light.radius) : std::sqrt(area);
    std::copy_n(light.centre, 3, out.position);
    std::copy_n(light.y, 3, out.normal);
    const double alpha = static_cast<double>(mean_alpha(impl.lights.alphas, light.alpha));
    store(mean_shape_emission(impl.scene, light) * (area * alpha), out.intensity);
    out.min_distance_squared = static_cast<float>(area / pi_d);
    out.flat = sphere ? 0 : 1;
    out.two_sided = light.two_sided;
    const double slack = 1e-5 * (length(vector(light.centre)) + size);
    out.radius = static_cast<float>((sphere ? size : 1e-3 * size) + slack);
    return out;
}

bool shines(const CentreLight& light) {
    return std::max({light.intensity[0], light.intensity[1], light.intensity[2]}) > 0;
}

/// Squared normalisation of each term's spherical harmonic, times the factor by which a cosine lobe
/// passes its band: pi, 2 pi / 3 and pi / 4.
constexpr std::array<double, ambient_terms> term_factors = {
    1.0 / 4, 1.0 / 2, 1.0 / 2, 1.0 / 2, 15.0 / 16, 15.0 / 16, 15.0 / 16, 5.0 / 64, 15.0 / 64};

using Terms = std::array<Vec3d, ambient_terms>;

/// A horizontal band of directions.
struct Band {
    double cosine;      ///< of the polar angle at the centre
    double steradians;  ///< of one pixel's part
};

/// Adds the part of one pixel row of the map that lies in a band.
void add_row(const EnvironmentView& map, int32_t row, const Band& band, Terms& sum) {
    const double cosine = band.cosine;
    const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    for (int32_t column = 0; column < map.width; ++column) {
        // u = 0.5 is +X and u grows towards +Z; the map is turned about +Y.
        const double azimuth = 2.0 * pi_d * ((column + 0.5) / map.width - 0.5);
        const double map_x = sine * std::cos(azimuth);
        const double map_z = sine * std::sin(azimuth);
        const double c = static_cast<double>(map.cos_rotation);
        const double s = static_cast<double>(map.sin_rotation);
        const Vec3d n{map_x * c + map_z * s, cosine, map_z * c - map_x * s};
        const float* pixel = map.pixels + 4 * (int64_t{row} * map.width + column);
        const Vec3d light = vector(pixel) * band.steradians;
        const AmbientBasis<double> basis = ambient_basis(n);
        for (size_t i = 0; i < sum.size(); ++i)
            sum[i] = sum[i] + light * basis.term[i];
    }
}

}  // namespace

AmbientLight project_environment(const EnvironmentView& map) {
    std::vector<Terms> rows(static_cast<size_t>(map.height));
    parallel_for(rows.size(), [&](size_t y) {
        // Tall pixels are cut into bands because the terms vary within them.
        const int bands = 1 + 256 / map.height;
        const double step = pi_d / (map.height * bands);
        for (int band = 0; band < bands; ++band) {
            const double polar = (static_cast<double>(y) * bands + band) * step;
            const double top = std::cos(polar);
            const double bottom = std::cos(polar + step);
            const double dw = 2.0 * pi_d / map.width * (top - bottom);
            add_row(map, static_cast<int32_t>(y), {0.5 * (top + bottom), dw}, rows[y]);
        }
    });
    AmbientLight out;
    for (size_t i = 0; i < term_factors.size(); ++i) {
        Vec3d sum = splat3(0.0);
        for (const Terms& row : rows)
            sum = sum + row[i];
        store(sum * term_factors[i], out.k[i]);
    }
    return out;
}

RaycastLights make_raycast_lights(const PreparedScene::Impl& impl) {
    RaycastLights out;
    const std::vector<EmitterRange> emitters = list_emitters(impl.scene);
    out.centres.resize(emitters.size());
    parallel_for(emitters.size(), [&](size_t i) { out.centres[i] = centre_of(impl, emitters[i]); });
    for (const ShapeLight& light : impl.lights.shapes)
        out.centres.push_back(centre_of(impl, light));
    out.centres.erase(std::remove_if(out.centres.begin(),
                                     out.centres.end(),
                                     [](const CentreLight& light) { return !shines(light); }),
                      out.centres.end());
    const bool has_environment = impl.environment && !impl.environment->black();
    if (has_environment) out.ambient = project_environment(impl.environment_view());
    out.headlight = !impl.environment && out.centres.empty() && impl.lights.punctual.empty();
    return out;
}

RaycastView RaycastLights::view() const {
    return {centres.data(),
            static_cast<int32_t>(centres.size()),
            ambient ? &*ambient : nullptr,
            headlight};
}

}  // namespace obscura
