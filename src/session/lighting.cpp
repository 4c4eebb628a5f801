// session/lighting.cpp - reads or makes the environment that is asked for.
// SPDX-License-Identifier: Apache-2.0
#include "session/lighting.h"

#include "base/memory_budget.h"
#include "image/decode.h"
#include "image/environment_memory.h"
#include "session/built_in_environment.h"

#include <cmath>

namespace obscura {

namespace {

/// An image whose bytes are in the memory budget for as long as somebody holds it.
struct ChargedImage {
    ImageRgb32f image;
    MemoryCharge charge;
};

Result<std::shared_ptr<const ImageRgb32f>> charged(ImageRgb32f&& image, const std::string& name) {
    const uint64_t bytes = environment_image_bytes(image.width, image.height);
    Result<MemoryCharge> charge = charge_memory(MemoryUse::environment, name, bytes);
    if (!charge) return fail(std::move(charge.error()));
    auto out = std::make_shared<ChargedImage>(ChargedImage{std::move(image), std::move(*charge)});
    return std::shared_ptr<const ImageRgb32f>(out, &out->image);
}

Result<std::shared_ptr<const ImageRgb32f>> load_environment(const RenderRequest& request,
                                                            Log& log) {
    const std::string name = request.environment->string();
    const Result<std::optional<BuiltInEnvironment>> built_in = parse_built_in_environment(name);
    if (!built_in) return fail(built_in.error());
    Result<ImageRgb32f> image = *built_in ? make_built_in_environment(**built_in)
                                          : read_environment(*request.environment, log);
    if (!image) return fail(image.error());
    if (request.space.from_rec709) convert_colors(*request.space.from_rec709, image->pixels);
    return charged(std::move(*image), name);
}

}  // namespace

Result<LightingOptions> load_lighting(const RenderRequest& request,
                                      Log& log,
                                      std::shared_ptr<const ImageRgb32f> environment) {
    LightingOptions lighting;
    lighting.environment_intensity = request.environment_intensity;
    lighting.environment_rotation_deg = request.environment_rotation_deg;
    lighting.catcher_ground = request.catcher_ground;
    if (!request.environment) return lighting;
    lighting.environment_name = request.environment->string();
    lighting.environment = std::move(environment);
    if (lighting.environment) return lighting;
    Result<std::shared_ptr<const ImageRgb32f>> loaded = load_environment(request, log);
    if (!loaded) return fail(loaded.error());
    lighting.environment = std::move(*loaded);
    return lighting;
}

double camera_azimuth_deg(const Affined& world_from_camera) {
    const auto& m = world_from_camera.m;
    constexpr double least = 1e-6;  // of the view axis that is horizontal
    const bool is_level = std::hypot(m[0][2], m[2][2]) > least;
    const double azimuth_rad =
        is_level ? std::atan2(m[0][2], m[2][2]) : std::atan2(-m[2][0], m[0][0]);
    return azimuth_rad * 180 / pi_d;
}

}  // namespace obscura
