// session/built_in_environment.cpp - the environments that have a name in place of a file.
// SPDX-License-Identifier: Apache-2.0
#include "session/built_in_environment.h"

#include "base/setting_names.h"
#include "base/text.h"
#include "light/daylight.h"
#include "light/studio.h"
#include "math/vec.h"
#include "math/warp.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

namespace obscura {

namespace {

constexpr double neutral_slope = 0.25;  ///< of the radiance, from the horizon to the zenith
constexpr int plain_width = 128;
constexpr int plain_height = 64;

std::optional<double> number_of(std::string_view text) {
    double out = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
    if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return out;
}

/// "35,120" of a sky.
Result<BuiltInEnvironment> parse_sky(const std::string& text, std::string_view angles) {
    const size_t comma = angles.find(',');
    const bool has_comma = comma != std::string_view::npos;
    const auto elevation = number_of(angles.substr(0, comma));
    const auto azimuth = number_of(has_comma ? angles.substr(comma + 1) : std::string_view{});
    if (!elevation || !azimuth) {
        return fail(ExitCode::usage,
                    "E-USAGE-NUMBER",
                    setting("env"),
                    in_quotes(text) +
                        " is not accepted; expected sky:ELEVATION,AZIMUTH in "
                        "degrees, such as sky:40,-30");
    }
    if (!(*elevation >= 0 && *elevation <= 90 && std::abs(*azimuth) <= 36000)) {
        return fail(ExitCode::usage,
                    "E-USAGE-RANGE",
                    setting("env"),
                    in_quotes(text) +
                        " is out of range; expected an elevation from 0 to 90 and "
                        "an azimuth from -36000 to 36000 degrees");
    }
    return BuiltInEnvironment{BuiltInEnvironmentKind::sky, *elevation, *azimuth};
}

/// A grey map whose radiance is 1 at the horizon.
ImageRgb32f plain_environment(double slope) {
    ImageRgb32f out{plain_width, plain_height, {}};
    for (int y = 0; y < plain_height; ++y) {
        const double height = std::cos(pi_d * (y + 0.5) / plain_height);
        out.pixels.insert(
            out.pixels.end(), size_t{3} * plain_width, static_cast<float>(1 + slope * height));
    }
    return out;
}

}  // namespace

Result<std::optional<BuiltInEnvironment>> parse_built_in_environment(const std::string& text) {
    using Kind = BuiltInEnvironmentKind;
    using Found = std::optional<BuiltInEnvironment>;
    if (text == "studio") return Found(BuiltInEnvironment{Kind::studio});
    if (text == "neutral") return Found(BuiltInEnvironment{Kind::neutral});
    if (text == "white") return Found(BuiltInEnvironment{Kind::white});
    constexpr std::string_view sky = "sky:";
    if (text != "sky" && !text.starts_with(sky)) return Found();
    const Result<BuiltInEnvironment> found =
        parse_sky(text, std::string_view(text).substr(std::min(text.size(), sky.size())));
    if (!found) return fail(found.error());
    return Found(*found);
}

ImageRgb32f make_built_in_environment(const BuiltInEnvironment& environment) {
    constexpr double degree = pi_d / 180;
    switch (environment.kind) {
        case BuiltInEnvironmentKind::neutral:
            return plain_environment(neutral_slope);
        case BuiltInEnvironmentKind::white:
            return plain_environment(0);
        case BuiltInEnvironmentKind::sky:
            return {daylight_width,
                    daylight_height,
                    make_daylight_pixels(environment.elevation_deg * degree,
                                         environment.azimuth_deg * degree)};
        case BuiltInEnvironmentKind::studio:
            break;
    }
    return {studio_width, studio_height, make_studio_pixels()};
}

}  // namespace obscura
