// denoise/reprojection.cpp - a neighbouring frame, moved to where this one shows its surfaces.
// SPDX-License-Identifier: Apache-2.0
#include "denoise/reprojection.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace obscura {

namespace {

struct PixelPlace {
    int x, y;
};

/// Where the neighbour shows the surfaces of this image.
class Reprojection {
public:
    Reprojection(const DenoiseInput& input, const NeighborFrame& neighbor)
        : size_{input.width, input.height}, neighbor_(neighbor), input_(input) {}

    /// Nothing: it does not.
    std::optional<PixelPlace> place_of(int x, int y) const {
        constexpr float astray = 1.5f;  // pixels; going to a pixel's middle alone makes 0.7
        const Vector there = motion(input_, x, y, neighbor_.is_after);
        const float at_x = static_cast<float>(x) + there.x;
        const float at_y = static_cast<float>(y) + there.y;
        if (!(at_x > -0.5f && at_x < static_cast<float>(size_.width) - 0.5f)) return {};
        if (!(at_y > -0.5f && at_y < static_cast<float>(size_.height) - 0.5f)) return {};
        const PixelPlace place{std::min(static_cast<int>(at_x + 0.5f), size_.width - 1),
                               std::min(static_cast<int>(at_y + 0.5f), size_.height - 1)};
        const Vector back = motion(neighbor_.input, place.x, place.y, !neighbor_.is_after);
        if (std::hypot(there.x + back.x, there.y + back.y) > astray) return {};
        return place;
    }

private:
    struct Vector {
        float x, y;
    };

    Vector motion(const DenoiseInput& from, int x, int y, bool to_frame_after) const {
        const float* const pixel = &from.motion[4 * size_.index(x, y)];
        return to_frame_after ? Vector{pixel[2], pixel[3]} : Vector{pixel[0], pixel[1]};
    }

    PlaneSize size_;
    const NeighborFrame& neighbor_;
    const DenoiseInput& input_;
};

}  // namespace

Frame reproject(const DenoiseInput& input, const NeighborFrame& neighbor) {
    const PlaneSize size{input.width, input.height};
    const Reprojection reprojection(input, neighbor);
    std::vector<std::optional<PixelPlace>> places(size.index(0, size.height));
    for_rows(size.height, [&](int y) {
        for (int x = 0; x < size.width; ++x)
            places[size.index(x, y)] = reprojection.place_of(x, y);
    });
    const auto move = [&](Plane& plane) {
        plane = size.plane([&](int x, int y) {
            const std::optional<PixelPlace>& place = places[size.index(x, y)];
            return place ? plane.row(place->y)[place->x] : 0.0f;
        });
    };
    const auto move_all = [&](Rgb& planes) {
        for (Plane& plane : planes)
            move(plane);
    };
    Frame out = make_frame(neighbor.input, neighbor.layers);
    FilterGuides& guides = out.guides;
    for (Rgb& half : guides.halves)
        move_all(half);
    move_all(guides.albedo);
    move_all(guides.normal);
    move(guides.feature_variance);
    move(guides.variance);
    move(guides.brightness_root);
    for (Rgb& layer : out.layers)
        move_all(layer);
    Plane share(size.width, size.height, plane_border);  // beyond the image nothing counts
    for_rows(size.height, [&](int y) {
        for (int x = 0; x < size.width; ++x) {
            const std::optional<PixelPlace>& place = places[size.index(x, y)];
            if (place) share.row(y)[x] = guides.share.row(place->y)[place->x];
        }
    });
    guides.share = std::move(share);
    guides.nearness = guides.slope_x = guides.slope_y = {};
    return out;
}

}  // namespace obscura
