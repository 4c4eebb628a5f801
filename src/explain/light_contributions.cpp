// explain/light_contributions.cpp - the sum of ray casting's lights, term by term.
// SPDX-License-Identifier: Apache-2.0
#include "explain/light_contributions.h"

#include "base/log.h"
#include "explain/names.h"
#include "render/raycast_lights.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace obscura {

namespace {

Vec3d wide(const float (&v)[3]) {
    return {v[0], v[1], v[2]};
}

Vec3d wide(const Vec3f& v) {
    return {v.x, v.y, v.z};
}

/// Direction and distance from one position to another.
void aim(const Vec3d& from, const Vec3d& to, LightContribution& out) {
    const Vec3d way = to - from;
    out.distance_m = length(way);
    out.direction = way * (1 / std::max(out.distance_m, 1e-300));
    out.terms.emplace_back("d", out.distance_m);
}

const char* type_name(PunctualType type) {
    switch (type) {
        case PunctualType::point:
            return "point";
        case PunctualType::spot:
            return "spot";
        case PunctualType::directional:
            break;
    }
    return "directional";
}

void shine(const PunctualLight& light, const Vec3d& from, LightContribution& out) {
    const Vec3d intensity = wide(light.intensity);
    out.terms.emplace_back("I", intensity);
    if (static_cast<PunctualType>(light.type) == PunctualType::directional) {
        out.direction = wide(light.direction) * -1.0;
        out.irradiance = intensity;
        out.formula = "E = I";
        return;
    }
    aim(from, wide(light.position), out);
    double factor = 1 / (out.distance_m * out.distance_m);
    out.formula = "E = I / d^2";
    if (light.range > 0.0f) {
        const double reach = out.distance_m / static_cast<double>(light.range);
        const double window = std::clamp(1 - std::pow(reach, 4), 0.0, 1.0);
        out.terms.emplace_back("w = 1 - (d / range)^4", window);
        out.formula = "E = w I / d^2";
        factor *= window;
    }
    if (static_cast<PunctualType>(light.type) == PunctualType::spot) {
        const Vec3d chord = wide(light.direction) + out.direction;
        const double cone =
            std::clamp(static_cast<double>(light.spot_on_axis) -
                           static_cast<double>(light.spot_scale) * dot(chord, chord) / 2,
                       0.0,
                       1.0);
        out.terms.emplace_back("k, of the cone", cone * cone);
        out.formula = light.range > 0.0f ? "E = w k I / d^2" : "E = k I / d^2";
        factor *= cone * cone;
    }
    out.irradiance = intensity * factor;
}

/// An IES lamp: what it emits this way is the renderer's own table in double.
void shine_measured(const LightTable& table,
                    size_t number,
                    const Vec3d& from,
                    LightContribution& out) {
    aim(from, wide(table.punctual[number].position), out);
    const auto sample = sample_punctual<double>(
        table.punctual.data(), static_cast<int32_t>(number), from, table.profiles.view());
    out.irradiance = sample.irradiance;
    out.formula = "E = I / d^2, I from the photometric file";
}

/// An emissive surface, concentrated in its centre.
void shine_from_centre(const CentreLight& light, const Vec3d& from, LightContribution& out) {
    const Vec3d intensity = wide(light.intensity);
    out.terms.emplace_back("I", intensity);
    aim(from, wide(light.position), out);
    double factor = 1 / std::max(out.distance_m * out.distance_m,
                                 static_cast<double>(light.min_distance_squared));
    out.formula = "E = I / d^2, d to the middle of a surface that shines";
    if (light.flat != 0) {
        const double cosine = -dot(out.direction, wide(light.normal));
        const double seen = light.two_sided != 0 ? std::abs(cosine) : std::max(cosine, 0.0);
        out.terms.emplace_back("cosine at the lamp", seen);
        out.formula = "E = I cosine / d^2, d to the middle of a flat surface that shines";
        factor *= seen;
    }
    out.irradiance = intensity * factor;
}

std::string name_of_light(const PreparedScene::Impl& prepared, size_t number) {
    const size_t punctual = prepared.lights.punctual.size();
    if (number >= punctual) return fmt::format("light {}, a surface that shines", number);
    const auto type = static_cast<PunctualType>(prepared.lights.punctual[number].type);
    const std::vector<std::string>& names = prepared.scene.info.light_names;
    std::string name = number < names.size() ? escape_control(names[number]) : "";
    if (!name.empty()) name = " '" + name + "'";
    return fmt::format("light {}{}, {}", number, name, type_name(type));
}

/// Names the object that blocks the renderer's shadow ray.
std::string blocker(const crosscheck::TrueScene& scene, const NotedLight& noted) {
    if (!noted.asked || length(noted.arrived) > 0) return "";
    const crosscheck::TrueHit hit = scene.nearest({wide(noted.start), wide(noted.direction)});
    if (!hit.found() || hit.t >= static_cast<double>(noted.distance_m)) return "something";
    return name_of_item(scene, hit.item);
}

}  // namespace

std::vector<LightContribution> find_light_contributions(const PreparedScene::Impl& prepared,
                                                        const crosscheck::TrueScene& scene,
                                                        const PixelReport& report) {
    const RaycastLights centres = make_raycast_lights(prepared);
    const size_t punctual = prepared.lights.punctual.size();
    const Vec3d from = report.seen ? report.seen->position : Vec3d{0, 0, 0};
    const Vec3d normal = report.seen ? report.seen->normal : Vec3d{0, 0, 0};
    std::vector<LightContribution> out;
    for (const NotedLight& noted : report.renderer.lights) {
        const auto number = static_cast<size_t>(noted.number);
        LightContribution contribution;
        contribution.name = name_of_light(prepared, number);
        if (number >= punctual) {
            shine_from_centre(centres.centres[number - punctual], from, contribution);
        } else if (prepared.lights.punctual[number].profile >= 0) {
            shine_measured(prepared.lights, number, from, contribution);
        } else {
            shine(prepared.lights.punctual[number], from, contribution);
        }
        contribution.cosine = dot(normal, contribution.direction);
        contribution.noted = noted;
        const double passes = static_cast<double>(report.renderer.passes);
        const Vec3d arriving = contribution.irradiance * (contribution.cosine * passes);
        const auto quotient = [](double a, double b) { return b > 0 ? a / b : 0.0; };
        const Vec3d offered = wide(noted.offered);
        contribution.bsdf = {quotient(offered.x, arriving.x),
                             quotient(offered.y, arriving.y),
                             quotient(offered.z, arriving.z)};
        contribution.blocked_by = blocker(scene, noted);
        out.push_back(std::move(contribution));
    }
    return out;
}

}  // namespace obscura
