// tests/stages/accumulate_test.cpp - samples become sums, on every instruction set of this CPU.
// SPDX-License-Identifier: Apache-2.0
#include "accel/accel_scenes.h"

#include <gtest/gtest.h>

#include <limits>

namespace obscura::test {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// The four columns of SampleColumns, padded as path_state.h asks.
class Samples {
public:
    void add(float r, float g, float b, float a) {
        const float values[] = {r, g, b, a};
        for (size_t c = 0; c < 4; ++c)
            channel_[c].push_back(values[c]);
    }
    SampleColumns columns() {
        for (std::vector<float>& column : padded_)
            column.clear();
        for (size_t c = 0; c < 4; ++c) {
            padded_[c] = channel_[c];
            padded_[c].resize(channel_[c].size() + 16, nan);
        }
        return {padded_[0].data(), padded_[1].data(), padded_[2].data(), padded_[3].data()};
    }
    float at(size_t channel, size_t slot) const { return padded_[channel][slot]; }
    size_t count() const { return channel_[0].size(); }

    /// Samples first .. first + count of every pixel.
    Samples part(size_t pixels, size_t first, size_t part_count) const {
        Samples out;
        const size_t per_pixel = count() / pixels;
        for (size_t pixel = 0; pixel < pixels; ++pixel) {
            for (size_t i = first; i < first + part_count; ++i) {
                const size_t slot = pixel * per_pixel + i;
                out.add(channel_[0][slot], channel_[1][slot], channel_[2][slot], channel_[3][slot]);
            }
        }
        return out;
    }

private:
    std::vector<float> channel_[4];
    std::vector<float> padded_[4];
};

/// The channels of all pixels' sums.
std::vector<float> sums_of(const std::vector<PixelSum>& sums) {
    std::vector<float> out;
    for (const PixelSum& sum : sums)
        out.insert(out.end(), std::begin(sum.block), std::end(sum.block));
    return out;
}

class Accumulate : public testing::TestWithParam<Isa> {
protected:
    const StageTable& stages() const { return stage_table_for(GetParam()); }
};

INSTANTIATE_TEST_SUITE_P(EveryIsa, Accumulate, testing::ValuesIn(all_isas()), [](const auto& isa) {
    return stage_table_for(isa.param).isa;
});

TEST_P(Accumulate, WhatIsNotFiniteIsCountedAndAddsNothing) {
    for (const float bad : {nan, -nan, infinity, -infinity, 1.1e30f, -3.3e38f}) {
        for (int channel = 0; channel < 3; ++channel) {
            Samples samples;
            float rgb[] = {0.5f, 0.25f, 0.125f};
            rgb[channel] = bad;
            samples.add(1, 2, 3, 1);
            samples.add(rgb[0], rgb[1], rgb[2], 1);
            samples.add(4, 5, 6, 0.5f);
            std::vector<PixelSum> sums = {{.block = {10, 20, 30, 40}}};
            EXPECT_EQ(stages().accumulate(1, {1, 3}, samples.columns(), sums.data()), 1U)
                << bad << " in channel " << channel;
            EXPECT_EQ(sums_of(sums), (std::vector<float>{15, 27, 39, 41.5f}))
                << bad << " in channel " << channel;
        }
    }
}

TEST_P(Accumulate, ChannelsThatAreHugeTogetherCountToo) {
    Samples samples;
    samples.add(0.4e30f, 0.4e30f, 0.4e30f, 1);
    samples.add(0.3e30f, 0.3e30f, 0.3e30f, 1);
    std::vector<PixelSum> sums(2);
    EXPECT_EQ(stages().accumulate(2, {0, 1}, samples.columns(), sums.data()), 1U);
    EXPECT_EQ(sums_of(sums), (std::vector<float>{0, 0, 0, 0, 0.3e30f, 0.3e30f, 0.3e30f, 1}));
}

TEST_P(Accumulate, EveryBadSampleOfEveryPixelCounts) {
    constexpr int pixels = 7;
    constexpr int per_pixel = 5;
    Samples samples;
    for (int i = 0; i < pixels * per_pixel; ++i) {
        const bool bad = i % per_pixel < i / per_pixel;  // pixel p has min(p, 5) of them
        samples.add(1, bad ? nan : 2.0f, 4, 1);
    }
    std::vector<PixelSum> sums(pixels);
    EXPECT_EQ(stages().accumulate(pixels, {0, per_pixel}, samples.columns(), sums.data()), 20U);
    for (int pixel = 0; pixel < pixels; ++pixel) {
        const auto good = static_cast<float>(std::max(per_pixel - pixel, 0));
        const float(&sum)[4] = sums[static_cast<size_t>(pixel)].block;
        EXPECT_EQ(sum[0], good);
        EXPECT_EQ(sum[1], 2 * good);
        EXPECT_EQ(sum[2], 4 * good);
        EXPECT_EQ(sum[3], good);
    }
}

TEST_P(Accumulate, SumsDoNotDependOnTheBatches) {
    constexpr size_t pixels = 5;
    constexpr size_t per_pixel = 12;
    Pcg32 random(3);
    Samples samples;
    for (size_t i = 0; i < pixels * per_pixel; ++i) {
        // Over many decades: any other order of sums would round differently.
        const float scale = std::exp2(between(random, -20, 20));
        const float red = scale * random.next_float();
        const float green = i % 17 == 3 ? infinity : scale * random.next_float();
        samples.add(red, green, scale * random.next_float(), random.next_float());
    }
    std::vector<PixelSum> whole(pixels);
    const SampleRange all{0, per_pixel};
    const uint64_t bad = stages().accumulate(pixels, all, samples.columns(), whole.data());
    EXPECT_EQ(bad, 4U);
    for (const std::vector<size_t>& cuts : {std::vector<size_t>{1, 11},
                                            std::vector<size_t>{5, 7},
                                            std::vector<size_t>{4, 4, 4},
                                            std::vector<size_t>(12, 1)}) {
        std::vector<PixelSum> sums(pixels);
        uint64_t bad_in_parts = 0;
        size_t first = 0;
        for (const size_t count : cuts) {
            Samples part = samples.part(pixels, first, count);
            const SampleRange range{static_cast<uint32_t>(first), static_cast<int>(count)};
            bad_in_parts += stages().accumulate(pixels, range, part.columns(), sums.data());
            first += count;
        }
        EXPECT_EQ(sums_of(sums), sums_of(whole)) << cuts.size() << " batches";
        EXPECT_EQ(bad_in_parts, bad);
    }
}

/// Adds samples [0, count) of one pixel, all equal, in batches of a size.
PixelSum sum_of_constant(const StageTable& stages, float value, uint32_t count, uint32_t batch) {
    Samples samples;
    for (uint32_t i = 0; i < batch; ++i)
        samples.add(value, 0.5f * value, value, 1);
    const SampleColumns columns = samples.columns();
    PixelSum sum;
    for (uint32_t first = 0; first < count; first += batch) {
        const uint32_t taken = std::min(batch, count - first);
        stages.accumulate(1, {first, static_cast<int>(taken)}, columns, &sum);
    }
    return sum;
}

TEST_P(Accumulate, AConstantIsRightAfterAMillionSamples) {
    for (const float value : {0.01f, 0.1f, 1.0f / 3, 0.7f, 0.9999999f, 1234.567f}) {
        for (const int samples : {1 << 16, 1 << 20, (1 << 20) - 777}) {
            const PixelSum sum =
                sum_of_constant(stages(), value, static_cast<uint32_t>(samples), 4096);
            EXPECT_NEAR(sum.mean(0, samples) / value, 1.0, 1e-6) << value << " " << samples;
            EXPECT_EQ(sum.mean(3, samples), 1.0f);
        }
    }
}

TEST_P(Accumulate, LongSumsDoNotDependOnTheBatches) {
    Pcg32 random(5);
    constexpr uint32_t count = 4096;
    std::vector<float> values;
    for (uint32_t i = 0; i < count; ++i)
        values.push_back(std::exp2(between(random, -20, 20)));
    const auto mean_in = [&](uint32_t batch) {
        PixelSum sum;
        for (uint32_t first = 0; first < count; first += batch) {
            const uint32_t taken = std::min(batch, count - first);
            Samples samples;
            for (uint32_t i = 0; i < taken; ++i)
                samples.add(values[first + i], 0, 0, 1);
            const SampleRange range{first, static_cast<int>(taken)};
            stages().accumulate(1, range, samples.columns(), &sum);
        }
        return sum.mean(0, count);
    };
    const float whole = mean_in(count);
    for (const uint32_t batch : {1U, 7U, 16U, 32U, 33U, 1000U, 1024U, 1025U})
        EXPECT_EQ(mean_in(batch), whole) << "batches of " << batch;
}

/// Layers of the light have to add up to this sum within 1e-5.
TEST_P(Accumulate, AConstantIsRightAfterAnyNumberOfSamples) {
    Pcg32 random(11);
    for (const int samples : {64, 200, 256, 257, 512, 768, 1024, 1500, 2048, 8192}) {
        for (int i = 0; i < 50; ++i) {
            const float value = between(random, 0.05f, 1.0f);
            const PixelSum sum =
                sum_of_constant(stages(), value, static_cast<uint32_t>(samples), 512);
            EXPECT_NEAR(sum.mean(0, samples) / value, 1.0, 1e-6) << value << " " << samples;
        }
    }
}

/// The samples of a block are one sum in float, as a loop would add them.
TEST_P(Accumulate, FewSamplesAreAddedOneByOne) {
    for (const int samples : {1, 7, 15, 16}) {
        const PixelSum sum = sum_of_constant(stages(), 0.7f, static_cast<uint32_t>(samples), 4);
        float expected = 0;
        for (int i = 0; i < samples; ++i)
            expected += 0.7f;
        EXPECT_EQ(sum.mean(0, samples), expected * (1.0f / static_cast<float>(samples)));
    }
}

TEST_P(Accumulate, OnlyUnoccludedShadowRaysArriveAtTheirSlots) {
    for (int count = 0; count <= 33; ++count) {
        Samples samples;
        for (int slot = 0; slot < 40; ++slot)
            samples.add(1, 2, 3, 0.5f);
        std::vector<float> r, g, b;
        std::vector<uint32_t> slots;
        std::vector<uint8_t> occluded;
        for (int i = 0; i < count + 16; ++i) {  // what lies past the last entry may be anything
            const bool exists = i < count;
            r.push_back(exists ? static_cast<float>(i + 1) : nan);
            g.push_back(exists ? 100.0f : nan);
            b.push_back(exists ? 0.25f : nan);
            slots.push_back(exists ? static_cast<uint32_t>(39 - i) : 0U);
            occluded.push_back(exists && i % 3 == 1 ? 1 : exists && i % 5 == 2 ? 255 : 0);
        }
        ShadowColumns shadows{};
        shadows.r = r.data();
        shadows.g = g.data();
        shadows.b = b.data();
        shadows.slot = slots.data();
        const SampleColumns columns = samples.columns();
        stages().add_shadows(count, shadows, occluded.data(), columns);
        for (int slot = 0; slot < 40; ++slot) {
            const int i = 39 - slot;
            const bool lit = i < count && i % 3 != 1 && i % 5 != 2;
            EXPECT_EQ(columns.r[slot], lit ? 1 + static_cast<float>(i + 1) : 1)
                << count << " " << i;
            EXPECT_EQ(columns.g[slot], lit ? 102.0f : 2.0f);
            EXPECT_EQ(columns.b[slot], lit ? 3.25f : 3.0f);
            EXPECT_EQ(columns.a[slot], 0.5f) << "light has no alpha";
        }
    }
}

}  // namespace
}  // namespace obscura::test
