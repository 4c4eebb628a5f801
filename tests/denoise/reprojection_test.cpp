// tests/denoise/reprojection_test.cpp - frames beside a frame help where they show the same.
// SPDX-License-Identifier: Apache-2.0
#include "denoise/reprojection.h"

#include "denoise/wall.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace obscura {
namespace {

constexpr int step = 3;  // pixels that the wall moves to the right from frame to frame

/// Light on the wall that no feature shows, and that is nowhere alike: numbers from 1 to 5.
float pattern(int x, int y) {
    constexpr int margin = 2 * step;
    static const std::vector<float> numbers = [] {
        std::mt19937 random(1);
        std::uniform_real_distribution<float> uniform(1, 5);
        std::vector<float> out(size_t{width + 2 * margin} * height);
        std::generate(out.begin(), out.end(), [&] { return uniform(random); });
        return out;
    }();
    return numbers[static_cast<size_t>(y * (width + 2 * margin) + x + margin)];
}

/// One of the frames -1, 0 and 1.
struct MovingWall {
    Wall wall;
    std::vector<float> motion = std::vector<float>(4 * pixels);
    int frame;

    explicit MovingWall(int frame_number) : frame(frame_number) {
        wall.light([&](int x, int y) { return pattern(x - frame * step, y); },
                   0.15f,
                   static_cast<unsigned>(50 + frame));
        for (size_t i = 0; i < pixels; ++i) {
            motion[4 * i] = -step;
            motion[4 * i + 2] = step;
        }
    }

    DenoiseInput input() const {
        DenoiseInput out = wall.input();
        out.motion = motion;
        return out;
    }
};

double error(const std::vector<float>& out) {
    return mean_square(out, pattern);
}

struct ThreeFrames {
    std::array<MovingWall, 3> frames = {MovingWall(0), MovingWall(-1), MovingWall(1)};

    std::vector<float> denoised() const {
        std::vector<float> out = frames[0].wall.mean();
        const std::vector<NeighborFrame> neighbors = {{false, frames[1].input(), {}},
                                                      {true, frames[2].input(), {}}};
        denoise(frames[0].input(), std::vector<LightImage>{{out, 3}}, neighbors);
        return out;
    }
};

TEST(Reprojection, TakesItsPixelsFromWhereTheSameSurfaceIsSeen) {
    const MovingWall now(0);
    MovingWall after(1);
    after.wall.light([](int x, int y) { return static_cast<float>(100 * y + x + 1); }, 0);
    const Frame seen = reproject(now.input(), {true, after.input(), {}});
    const Frame itself = make_frame(after.input(), {});
    EXPECT_EQ(seen.guides.share.row(0)[-1], 0) << "beyond the image nothing counts";
    EXPECT_EQ(seen.guides.share.row(-1)[0], 0);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const bool is_inside = x + step < width;
            ASSERT_EQ(seen.guides.share.row(y)[x], is_inside ? 1 : 0) << x << " " << y;
            if (!is_inside) continue;
            ASSERT_EQ(seen.guides.halves[1][2].row(y)[x],
                      itself.guides.halves[1][2].row(y)[x + step]);
        }
    }
}

TEST(Reprojection, TakesNoiseOutThatOneFrameCannot) {
    const ThreeFrames three;
    EXPECT_LT(error(three.denoised()), 0.5 * error(three.frames[0].wall.denoised()));
    EXPECT_NEAR(total_light(three.denoised()) / total_light(three.frames[0].wall.mean()), 1, 1e-5);
}

/// Something else is in front there: motion does not lead back.
TEST(Reprojection, WhatIsOutOfSightCountsForNothing) {
    ThreeFrames three;
    for (size_t i = 0; i < pixels; ++i) {
        three.frames[1].motion[4 * i + 2] = step + 2;
        three.frames[2].motion[4 * i + 1] = 2;
    }
    EXPECT_EQ(three.denoised(), three.frames[0].wall.denoised());
}

/// Light that changes from frame to frame is not smeared over time.
TEST(Reprojection, WhatLooksOtherwiseThereCountsForLittle) {
    ThreeFrames three;
    for (size_t k : {1U, 2U}) {
        three.frames[k].wall.light([](int x, int y) { return 5 * pattern(x, y); }, 0.15f, 3);
    }
    EXPECT_LT(error(three.denoised()), 1.3 * error(three.frames[0].wall.denoised()));
}

TEST(Reprojection, LayersStillAddUp) {
    ThreeFrames three;
    std::array<std::vector<float>, 3> beauties, ones, others;
    for (size_t k = 0; k < 3; ++k) {
        three.frames[k].wall.halves[1][size_t{3} * 777] = 500;
        beauties[k] = three.frames[k].wall.mean();
        ones[k] = others[k] = beauties[k];
        for (size_t i = 0; i < 3 * pixels; ++i) {
            ones[k][i] *= static_cast<float>(i % 97) / 97.0f;
            others[k][i] -= ones[k][i];
        }
    }
    std::vector<NeighborFrame> neighbors;
    for (size_t k : {1U, 2U}) {
        neighbors.push_back({k == 2, three.frames[k].input(), {{ones[k], 3}, {others[k], 3}}});
    }
    denoise(three.frames[0].input(),
            std::vector<LightImage>{{beauties[0], 3}, {ones[0], 3}, {others[0], 3}},
            neighbors);
    for (size_t i = 0; i < 3 * pixels; ++i) {
        ASSERT_NEAR(ones[0][i] + others[0][i], beauties[0][i], 2e-5f * beauties[0][i]) << i;
    }
}

}  // namespace
}  // namespace obscura
