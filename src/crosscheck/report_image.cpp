// crosscheck/report_image.cpp - a picture of where on the screen answers differ from the truth.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/report_image.h"

#include <array>

namespace obscura {

namespace {

std::array<float, 3> color_of(int worst, bool hit) {
    if (worst < 0) return {0, 0, 0};
    switch (static_cast<Finding>(worst)) {
        case Finding::agree:
            break;
        case Finding::equal_depth:
            return {0.2f, 0.4f, 1};
        case Finding::edge:
            return {0.1f, 0.8f, 0.2f};
        case Finding::crack:
        case Finding::edge_on:
            return {1, 0.85f, 0};
        case Finding::place:
        case Finding::item:
        case Finding::depth:
        case Finding::missed:
        case Finding::false_hit:
            return {1, 0, 0};
    }
    const float grey = hit ? 0.55f : 0.2f;
    return {grey, grey, grey};
}

}  // namespace

Picture screen_picture(const ScreenVerdicts& screen) {
    Picture picture;
    picture.width = screen.width;
    picture.height = screen.height;
    picture.channels = {"R", "G", "B"};
    picture.pixels = UnsetArray<float>(screen.worst.size() * 3);
    for (size_t i = 0; i < screen.worst.size(); ++i) {
        const std::array<float, 3> color = color_of(screen.worst[i], screen.hit[i] != 0);
        for (size_t c = 0; c < 3; ++c)
            picture.pixels[3 * i + c] = color[c];
    }
    return picture;
}

}  // namespace obscura
