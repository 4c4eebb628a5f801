// crosscheck/report_image.cpp - an image that shows where answers differ from the truth.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/report_image.h"

#include <array>

namespace obscura::crosscheck {

namespace {

std::array<float, 3> color_of(int worst, bool hit) {
    if (worst < 0) return {0, 0, 0};
    switch (static_cast<Verdict>(worst)) {
        case Verdict::agree:
            break;
        case Verdict::equal_depth:
            return {0.2f, 0.4f, 1};
        case Verdict::edge:
            return {0.1f, 0.8f, 0.2f};
        case Verdict::crack:
        case Verdict::edge_on:
            return {1, 0.85f, 0};
        case Verdict::place:
        case Verdict::item:
        case Verdict::depth:
        case Verdict::missed:
        case Verdict::false_hit:
            return {1, 0, 0};
    }
    const float grey = hit ? 0.55f : 0.2f;
    return {grey, grey, grey};
}

}  // namespace

OutputImage screen_image(const ScreenVerdicts& screen) {
    OutputImage image;
    image.width = screen.width;
    image.height = screen.height;
    image.channels = {"R", "G", "B"};
    image.pixels = UnsetArray<float>(screen.worst.size() * 3);
    for (size_t i = 0; i < screen.worst.size(); ++i) {
        const std::array<float, 3> color = color_of(screen.worst[i], screen.hit[i] != 0);
        for (size_t c = 0; c < 3; ++c)
            image.pixels[3 * i + c] = color[c];
    }
    return image;
}

}  // namespace obscura::crosscheck
