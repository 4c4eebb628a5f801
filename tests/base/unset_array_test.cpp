// tests/base/unset_array_test.cpp - large arrays begin as zeros, whatever lay in memory before.
// SPDX-License-Identifier: Apache-2.0
#include "base/unset_array.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>

namespace obscura {
namespace {

bool is_zero(const UnsetArray<float>& array) {
    return std::all_of(array.begin(), array.end(), [](float value) { return value == 0.0f; });
}

TEST(UnsetArray, OfZerosHasThemInMemoryThatWasUsedBefore) {
    constexpr size_t large = LargePageAllocator<float>::smallest_large / sizeof(float);
    for (const size_t count :
         {size_t{0}, size_t{1}, size_t{100}, large - 1, large, 3 * large + 1}) {
        for (int turn = 0; turn < 3; ++turn) {
            UnsetArray<float> array = zero_array<float>(count);
            ASSERT_EQ(array.size(), count);
            EXPECT_TRUE(is_zero(array)) << count;
            std::fill(array.begin(), array.end(), 1.0f);
        }
    }
}

TEST(UnsetArray, BeginsWithALargePageWhereItIsLarge) {
    constexpr size_t large = LargePageAllocator<float>::smallest_large / sizeof(float);
    for (const size_t count : {large, large + 1, 5 * large / 2}) {
        const UnsetArray<float> first(count), second(count);
        EXPECT_EQ(reinterpret_cast<uintptr_t>(first.data()) % (size_t{2} << 20U), 0U);
        EXPECT_EQ(reinterpret_cast<uintptr_t>(second.data()) % (size_t{2} << 20U), 0U);
        EXPECT_NE(first.data(), second.data());
    }
}

TEST(UnsetArray, ThrowsWhenThereIsNoSuchMemory) {
    EXPECT_THROW(UnsetArray<float>(size_t{1} << 60U), std::bad_alloc);
}

}  // namespace
}  // namespace obscura
