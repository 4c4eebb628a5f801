// session/dark_image.cpp - warns of finished images that are nearly black.
// SPDX-License-Identifier: Apache-2.0
#include "session/dark_image.h"

#include "base/setting_names.h"
#include "base/text.h"
#include "math/vec.h"
#include "session/exposure_meter.h"
#include "session/preview.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace obscura {

namespace {

constexpr double darkest = 0.01;              ///< mean of the whole image
constexpr double darkest_covered = 1.0 / 16;  ///< mean of what is covered: small things may be lit

/// Offset of a channel in a pixel.
std::optional<size_t> find_channel(const OutputImage& image, const char* name) {
    const auto found = std::find(image.channels.begin(), image.channels.end(), name);
    if (found == image.channels.end()) return std::nullopt;
    return static_cast<size_t>(found - image.channels.begin());
}

/// Whether surfaces emit: they keep the studio away, which lights scenes without any light.
bool glows(const Scene& scene) {
    return std::any_of(
        scene.materials.begin(), scene.materials.end(), [](const Material& material) {
            return *std::max_element(std::begin(material.emission), std::end(material.emission)) >
                   0;
        });
}

bool has_environment(const RenderRequest& request, const Scene& scene) {
    return request.environment.has_value() || scene.environment != nullptr;
}

std::string lights_text(const RenderRequest& request, const Scene& scene) {
    std::string out;
    const auto add = [&](const std::string& text) { out += (out.empty() ? "" : " and ") + text; };
    if (request.environment) {
        add("the environment " + request.environment->filename().string());
    } else if (scene.environment) {
        add("the file's own environment");
    }
    const size_t count = scene.lights.size();
    if (count == 1) {
        const auto& names = scene.info.light_names;
        add("the file's one light" + (names.empty() ? "" : " " + in_quotes(names.front())));
    } else if (count > 1) {
        add("the file's " + std::to_string(count) + " lights");
    }
    if (glows(scene)) add("what glows in it");
    if (!out.empty()) return out;
    const bool all_unlit =
        std::all_of(scene.materials.begin(), scene.materials.end(), [](const Material& material) {
            return (material.flags & material_unlit) != 0;
        });
    return all_unlit && !scene.materials.empty() ? "nothing, as its materials are unlit"
                                                 : "the studio";
}

/// Sums over all pixels.
struct LuminanceSum {
    double luminance = 0;
    double covered = 0;  ///< alpha
    double pixels = 0;
};

/// Nothing without channels R, G and B.
std::optional<LuminanceSum> sum_luminance(const OutputImage& image) {
    constexpr std::array<const char*, 3> names = {"R", "G", "B"};
    std::array<size_t, 3> offsets = {};
    for (size_t c = 0; c < 3; ++c) {
        const std::optional<size_t> offset = find_channel(image, names[c]);
        if (!offset) return std::nullopt;
        offsets[c] = *offset;
    }
    const std::optional<size_t> alpha = find_channel(image, "A");
    LuminanceSum sum;
    for (size_t at = 0; at < image.pixels.size(); at += image.channels.size()) {
        const auto channel = [&](size_t c) { return image.pixels[at + offsets[c]]; };
        const Vec3f color{channel(0), channel(1), channel(2)};
        sum.luminance += static_cast<double>(luminance(color));
        sum.covered += alpha ? static_cast<double>(image.pixels[at + *alpha]) : 1.0;
        sum.pixels += 1;
    }
    return sum;
}

}  // namespace

std::optional<double> mean_luminance(const OutputImage& image) {
    const std::optional<LuminanceSum> sum = sum_luminance(image);
    if (!sum || !(sum->covered > 0)) return std::nullopt;
    return sum->luminance / sum->covered;
}

void warn_of_dark_image(const OutputImage& image,
                        const RenderRequest& request,
                        const Scene& scene,
                        double exposure_ev,
                        Log& log) {
    // A background of one colour says nothing about the light, and may well be black.
    const RenderOptions& options = request.options;
    if (needs_preview(options.integrator) || options.background == BackgroundKind::color) return;
    if (scene.primitives.empty() && scene.splats.empty()) return;
    const std::optional<LuminanceSum> sum = sum_luminance(image);
    if (!sum || !(sum->covered > 0)) return;
    const double shown = sum->luminance / sum->covered * std::exp2(exposure_ev);
    const double of_image = sum->luminance / sum->pixels * std::exp2(exposure_ev);
    if (!(of_image < darkest && shown < darkest_covered)) return;
    std::string help;
    if (!has_environment(request, scene)) {
        if (glows(scene)) {
            help += setting("env") + " studio lights it by the studio, too; ";
        } else if (!scene.lights.empty()) {
            help += setting("lights") + " off lights it by the studio instead; ";
        }
    }
    if (shown > 0) {
        const double stops = request.display.exposure_ev + std::log2(middle_grey / shown);
        help += setting("exposure") + " " + shortest(std::round(10 * stops) / 10) +
                " makes the mean of what it shows a middle grey";
    } else {
        help += "no light reaches what is seen";
    }
    log.warn(request.scene.string(),
             "the image is nearly black: its mean is " +
                 shortest(std::round(1e5 * of_image) / 1000) + " % of white, lit by " +
                 lights_text(request, scene) + "; " + help);
}

}  // namespace obscura
