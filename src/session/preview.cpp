// session/preview.cpp - 8-bit previews of AOVs, readable without a colour transform.
// SPDX-License-Identifier: Apache-2.0
#include "session/preview.h"

#include "surface/srgb.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace obscura {

namespace {

constexpr float farthest_grey = 0.15f;

using Rgb = std::array<float, 3>;

/// The first channels of one pixel: up to three besides alpha.
struct Layout {
    size_t stride = 0;
    std::vector<size_t> values;
};

Layout layout_of(const OutputImage& image) {
    Layout layout;
    layout.stride = image.channels.size();
    for (size_t i = 0; i < layout.stride && layout.values.size() < 3; ++i) {
        if (image.channels[i] != "A") layout.values.push_back(i);
    }
    return layout;
}

Rgb values_at(const OutputImage& image, const Layout& layout, size_t pixel) {
    Rgb values = {0, 0, 0};
    for (size_t i = 0; i < layout.values.size(); ++i) {
        const float value = image.pixels[pixel * layout.stride + layout.values[i]];
        values[i] = std::isfinite(value) ? value : 0.0f;
    }
    return values;
}

/// Least and greatest value of the first channel; 0 marks pixels without a hit.
std::array<float, 2> value_range(const OutputImage& image, const Layout& layout, size_t pixels) {
    float least = INFINITY;
    float greatest = 0;
    for (size_t i = 0; i < pixels; ++i) {
        const float value = values_at(image, layout, i)[0];
        if (value <= 0) continue;
        least = std::min(least, value);
        greatest = std::max(greatest, value);
    }
    return {least, greatest};
}

/// The value that one pixel in a hundred exceeds, so that few hot ones do not darken the rest.
float hot_value(const OutputImage& image, const Layout& layout, size_t pixels) {
    std::vector<float> values(pixels);
    for (size_t i = 0; i < pixels; ++i)
        values[i] = values_at(image, layout, i)[0];
    const auto place = values.begin() + static_cast<long>((pixels - 1) * 99 / 100);
    std::nth_element(values.begin(), place, values.end());
    return *place;
}

Rgb depth_color(float depth, const std::array<float, 2>& range) {
    if (depth <= 0) return {0, 0, 0};
    const float span = range[1] - range[0];
    const float relative = span > 0 ? (depth - range[0]) / span : 0.0f;
    const float grey = 1.0f - (1.0f - farthest_grey) * relative;
    return {grey, grey, grey};
}

/// The ramp of glowing metal; heat in [0, 1].
Rgb heat_color(float heat) {
    const auto ramp = [&](float begin) { return std::clamp(3.0f * heat - begin, 0.0f, 1.0f); };
    return {ramp(0), ramp(1), ramp(2)};
}

float fraction(float x) {
    return x - std::floor(x);
}

Rgb normal_color(const Rgb& n) {
    if (n[0] == 0 && n[1] == 0 && n[2] == 0) return {0, 0, 0};
    return {0.5f * n[0] + 0.5f, 0.5f * n[1] + 0.5f, 0.5f * n[2] + 0.5f};
}

/// Finaliser of SplitMix64: every input bit moves every output bit.
/// Source: Steele, Lea, Flood, "Fast Splittable Pseudorandom Number Generators", OOPSLA 2014
uint64_t mix_bits(uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
    return x ^ (x >> 31);
}

Rgb id_color(const Rgb& ids) {
    uint64_t hash = 0;
    bool any = false;
    for (const float id : ids) {
        any = any || id != 0;
        hash = mix_bits(hash + 0x9e3779b97f4a7c15U + std::bit_cast<uint32_t>(id));
    }
    if (!any) return {0, 0, 0};
    const auto bright = [&](int shift) {
        return 0.2f + 0.8f * static_cast<float>((hash >> shift) & 0xFF) / 255.0f;
    };
    return {bright(0), bright(20), bright(40)};
}

}  // namespace

bool needs_preview(Integrator integrator) {
    return integrator != Integrator::path && integrator != Integrator::direct &&
           integrator != Integrator::raycast;
}

OutputImage preview_image(const OutputImage& image, Integrator integrator) {
    const Layout layout = layout_of(image);
    const size_t pixels = static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
    const std::array<float, 2> range = value_range(image, layout, pixels);
    const float hottest = integrator == Integrator::heat ? hot_value(image, layout, pixels) : 0.0f;
    OutputImage out;
    out.width = image.width;
    out.height = image.height;
    out.channels = {"R", "G", "B"};
    out.pixels.resize(3 * pixels);
    for (size_t i = 0; i < pixels; ++i) {
        const Rgb values = values_at(image, layout, i);
        Rgb color = {};
        switch (integrator) {
            case Integrator::normal:
                color = normal_color(values);
                break;
            case Integrator::uv:
                color = {fraction(values[0]), fraction(values[1]), 0.0f};
                break;
            case Integrator::heat:
                color = heat_color(values[0] / std::max(hottest, 1.0f));
                break;
            case Integrator::depth:
            case Integrator::distance:
                color = depth_color(values[0], range);
                break;
            case Integrator::id:
                color = id_color(values);
                break;
            default:
                for (size_t c = 0; c < 3; ++c) {
                    const float value = values[layout.values.size() == 3 ? c : 0];
                    color[c] = srgb_from_linear(std::clamp(value, 0.0f, 1.0f));
                }
        }
        std::copy(color.begin(), color.end(), out.pixels.begin() + static_cast<long>(3 * i));
    }
    return out;
}

}  // namespace obscura
