// tests/support/environment_maps.h - small environment maps that are hard to sample.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "light/environment_table.h"

#include "support/random.h"
#include <cmath>
#include <vector>

namespace obscura {

struct TestMap {
    int width = 0;
    int height = 0;
    std::vector<float> rgb;

    TestMap(int map_width, int map_height)
        : width(map_width),
          height(map_height),
          rgb(static_cast<size_t>(map_width) * static_cast<size_t>(map_height) * 3, 0.0F) {}

    float* pixel(int x, int y) { return rgb.data() + 3 * (y * width + x); }
    const float* pixel(int x, int y) const { return rgb.data() + 3 * (y * width + x); }
    void set(int x, int y, const Vec3f& value) {
        pixel(x, y)[0] = value.x;
        pixel(x, y)[1] = value.y;
        pixel(x, y)[2] = value.z;
    }
    EnvironmentImage image() const { return {width, height, rgb.data()}; }
};

/// Noise over three decades, a third of it black, and one pixel that outshines the rest.
inline TestMap noisy_map(int width, int height, uint64_t seed) {
    TestMap map(width, height);
    Pcg32 random(seed);
    for (float& value : map.rgb) {
        const float u = random.next_float();
        value = u < 0.33F ? 0.0F : std::exp2(10 * u - 8);
    }
    map.set(width / 3, height / 4, {900, 800, 500});
    return map;
}

/// A blue gradient with a sun of 20,000 near the horizon and a dark ground.
inline TestMap sky_map(int width, int height) {
    TestMap map(width, height);
    for (int y = 0; y < height; ++y) {
        const float elevation = 1 - 2 * (static_cast<float>(y) + 0.5F) / static_cast<float>(height);
        const Vec3f sky{0.3F - 0.2F * elevation, 0.5F - 0.2F * elevation, 0.9F};
        for (int x = 0; x < width; ++x) {
            map.set(x, y, elevation > 0 ? sky : Vec3f{0.05F, 0.04F, 0.03F});
        }
    }
    const int row = 2 * height / 5;
    map.set(width - 1, row, {20000, 18000, 15000});  // its light wraps around the map's border
    return map;
}

/// The table of a valid map.
inline EnvironmentTable table_of(const TestMap& map, double rotation_deg = 0) {
    return EnvironmentTable::create(map.image(), 1.0, rotation_deg).value();
}

}  // namespace obscura
