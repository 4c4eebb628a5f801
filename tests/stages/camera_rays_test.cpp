// tests/stages/camera_rays_test.cpp - a sample's ray does not depend on the samples beside it.
// SPDX-License-Identifier: Apache-2.0
#include "accel/accel_scenes.h"
#include "stages/wavefront.h"

#include <gtest/gtest.h>

#include <array>

namespace obscura::test {
namespace {

/// Some pixels lie outside of the image, as those of overscan do.
constexpr std::array<int32_t, 5> pixel_x = {0, 3, -2, 63, 64};
constexpr std::array<int32_t, 5> pixel_y = {0, -1, 7, 64, 5};
constexpr int all_samples = 48;  // groups of 4, 8 and 16 lanes are of one pixel

class CameraRays : public testing::TestWithParam<Isa> {
protected:
    /// What tells one ray from another.
    using Ray = std::array<uint32_t, 6>;

    /// The rays of all samples, made in batches of `per_batch` samples a pixel: pixel by pixel.
    std::vector<Ray> make(int per_batch, int z_order_bits) {
        BatchSettings batch;
        batch.camera = look_at({0, 0, 5}, {0, 0, 0}, 0.7f, 70, 70);
        batch.width = batch.height = 70;
        batch.pixel_x = pixel_x.data();
        batch.pixel_y = pixel_y.data();
        batch.samples = per_batch;
        batch.seed_low = 17;
        batch.z_order_bits = z_order_bits;
        std::vector<Ray> out(pixel_x.size() * all_samples);
        for (int first = 0; first < all_samples; first += per_batch) {
            batch.first_sample = static_cast<uint32_t>(first);
            const int count = static_cast<int>(pixel_x.size()) * per_batch;
            const PathColumns& paths = work_.paths[0];
            stage_table_for(GetParam()).camera(batch, count, paths, work_.samples, nullptr);
            for (int i = 0; i < count; ++i) {
                EXPECT_EQ(paths.slot[i], static_cast<uint32_t>(i));
                const int place = i / per_batch * all_samples + first + i % per_batch;
                out[static_cast<size_t>(place)] = ray(paths, i);
            }
        }
        return out;
    }

private:
    static Ray ray(const PathColumns& paths, int i) {
        return {std::bit_cast<uint32_t>(paths.dx[i]),
                std::bit_cast<uint32_t>(paths.dy[i]),
                std::bit_cast<uint32_t>(paths.dz[i]),
                paths.key[i],
                paths.sample[i],
                paths.path_key[i]};
    }

    Workspace work_;
};

INSTANTIATE_TEST_SUITE_P(EveryIsa, CameraRays, testing::ValuesIn(all_isas()), [](const auto& isa) {
    return stage_table_for(isa.param).isa;
});

TEST_P(CameraRays, AreThoseOfAnyBatches) {
    for (const int z_order_bits : {-1, 6}) {
        const std::vector<Ray> one_by_one = make(1, z_order_bits);
        for (const int per_batch : {2, 3, 4, 8, 12, 16, 24, 48})
            EXPECT_EQ(make(per_batch, z_order_bits), one_by_one) << per_batch;
        EXPECT_NE(one_by_one[0], one_by_one[1]);
        EXPECT_NE(one_by_one[0], one_by_one[all_samples]);
    }
}

}  // namespace
}  // namespace obscura::test
