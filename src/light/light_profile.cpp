// light/light_profile.cpp - packs photometric profiles into a table; computes their flux.
// SPDX-License-Identifier: Apache-2.0
#include "light/light_profile.h"

#include <cmath>

namespace obscura {

namespace {

/// Integral of one plane's intensity times the sine of the polar angle, over the polar angle.
double plane_integral(const LightProfile& profile, size_t plane) {
    const size_t count = profile.polar_deg.size();
    const auto radians = [&](size_t i) {
        return static_cast<double>(profile.polar_deg[i]) * (pi_d / 180.0);
    };
    double sum = 0;
    for (size_t i = 0; i + 1 < count; ++i) {
        const double begin = radians(i);
        const double end = radians(i + 1);
        const auto first = static_cast<double>(profile.candela[plane * count + i]);
        const auto second = static_cast<double>(profile.candela[plane * count + i + 1]);
        const double slope = (second - first) / (end - begin);
        sum += first * (std::cos(begin) - std::cos(end)) +
               slope * (std::sin(end) - std::sin(begin) - (end - begin) * std::cos(end));
    }
    return sum;
}

}  // namespace

double profile_lumens(const LightProfile& profile) {
    const std::vector<float>& azimuth = profile.azimuth_deg;
    if (azimuth.size() == 1) return 2.0 * pi_d * plane_integral(profile, 0);
    double sum = 0;
    for (size_t i = 0; i + 1 < azimuth.size(); ++i) {
        const double width = static_cast<double>(azimuth[i + 1]) - static_cast<double>(azimuth[i]);
        const double mean = 0.5 * (plane_integral(profile, i) + plane_integral(profile, i + 1));
        sum += width * (pi_d / 180.0) * mean;
    }
    return sum;
}

LightProfileTable pack_light_profiles(std::span<const LightProfile> profiles) {
    LightProfileTable table;
    const auto append = [&](const std::vector<float>& values) {
        const auto first = static_cast<int32_t>(table.words.size());
        table.words.insert(table.words.end(), values.begin(), values.end());
        return first;
    };
    for (const LightProfile& profile : profiles) {
        table.records.push_back({append(profile.polar_deg),
                                 static_cast<int32_t>(profile.polar_deg.size()),
                                 append(profile.azimuth_deg),
                                 static_cast<int32_t>(profile.azimuth_deg.size()),
                                 append(profile.candela)});
    }
    return table;
}

LightProfileView LightProfileTable::view() const {
    return records.empty() ? LightProfileView{} : LightProfileView{records.data(), words.data()};
}

}  // namespace obscura
