// tests/render/filter_table_test.cpp - the tables of the reconstruction filters.
// SPDX-License-Identifier: Apache-2.0
#include "render/filter_table.h"

#include "stages/path_state.h"

#include <gtest/gtest.h>

#include <cmath>

namespace obscura::test {
namespace {

/// Gaussian of standard deviation 0.5, cut at 1.5: the error function.
double gaussian_cdf(double x) {
    const double scale = 1.0 / (0.5 * std::sqrt(2.0));
    return 0.5 + 0.5 * std::erf(x * scale) / std::erf(1.5 * scale);
}

/// Integral of the four-term window over t = x / 1.65 in [-1, t], divided by that over [-1, 1]; its
/// middle lies at t = 0, so the odd cosines change their sign.
double blackman_harris_cdf(double x) {
    const double t = x / 1.65;
    const auto wave = [&](double k) { return std::sin(k * pi_d * t) / (k * pi_d); };
    const double integral =
        0.35875 * (t + 1) + 0.48829 * wave(1) + 0.14128 * wave(2) + 0.01168 * wave(3);
    return integral / (2 * 0.35875);
}

struct FilterCase {
    const char* name;
    PixelFilter filter;
    double radius;
    double (*cdf)(double x);
};

class FilterTable : public testing::TestWithParam<FilterCase> {
protected:
    std::vector<float> table_ = make_filter_table(GetParam().filter);
    static constexpr size_t last = filter_entries;
};

INSTANTIATE_TEST_SUITE_P(
    Filters,
    FilterTable,
    testing::Values(FilterCase{"Gaussian", PixelFilter::gaussian, 1.5, gaussian_cdf},
                    FilterCase{
                        "BlackmanHarris", PixelFilter::blackman_harris, 1.65, blackman_harris_cdf}),
    [](const auto& filter) { return filter.param.name; });

TEST(FilterTable, TheBoxHasNone) {
    EXPECT_TRUE(make_filter_table(PixelFilter::box).empty());
}

TEST_P(FilterTable, RisesFromEdgeToEdge) {
    ASSERT_EQ(table_.size(), last + 1);
    EXPECT_NEAR(static_cast<double>(table_[0]), -GetParam().radius, 1e-3);
    EXPECT_NEAR(static_cast<double>(table_[last]), GetParam().radius, 1e-3);
    for (size_t k = 0; k < last; ++k)
        EXPECT_LT(table_[k], table_[k + 1]) << k;
}

TEST_P(FilterTable, IsSymmetric) {
    ASSERT_EQ(table_.size(), last + 1);
    for (size_t k = 0; k <= last; ++k)
        EXPECT_NEAR(table_[k], -table_[last - k], 1e-4f) << k;
    EXPECT_NEAR(table_[last / 2], 0.0f, 1e-5f);
}

TEST_P(FilterTable, EntriesLieWhereTheClosedFormPutsThem) {
    ASSERT_EQ(table_.size(), last + 1);
    for (size_t k = 0; k <= last; ++k) {
        const double expected = static_cast<double>(k) / filter_entries;
        EXPECT_NEAR(GetParam().cdf(static_cast<double>(table_[k])), expected, 1e-6) << k;
    }
}

/// Reads as the camera stage does: linearly between entries.
TEST_P(FilterTable, ItsHistogramIsTheFilter) {
    ASSERT_EQ(table_.size(), last + 1);
    constexpr int bins = 60;
    constexpr int draws = 1 << 18;
    std::vector<double> share(bins, 0.0);
    const double radius = GetParam().radius;
    for (int i = 0; i < draws; ++i) {
        const double x = (i + 0.5) / draws * filter_entries;
        const auto k = static_cast<size_t>(x);
        const double low = static_cast<double>(table_[k]);
        const double high = static_cast<double>(table_[k + 1]);
        const double offset = low + (high - low) * (x - std::floor(x));
        const auto bin = static_cast<int>((offset / radius + 1) * 0.5 * bins);
        share[static_cast<size_t>(std::clamp(bin, 0, bins - 1))] += 1.0 / draws;
    }
    for (int bin = 0; bin < bins; ++bin) {
        const double low = radius * (2.0 * bin / bins - 1);
        const double high = radius * (2.0 * (bin + 1) / bins - 1);
        const double expected = GetParam().cdf(high) - GetParam().cdf(low);
        // Within an entry the density is constant; entries are wide only in the tails.
        const bool tail = std::max(-low, high) > 0.6 * radius;
        const double bound = tail ? 1e-3 : 0.02 * expected;
        EXPECT_NEAR(share[static_cast<size_t>(bin)], expected, bound) << "from " << low;
    }
}

}  // namespace
}  // namespace obscura::test
