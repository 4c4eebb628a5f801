// tests/base/page_map_test.cpp - pages that nobody has used are zeros, and stay unused.
// SPDX-License-Identifier: Apache-2.0
#include "base/page_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <unistd.h>

namespace obscura {
namespace {

TEST(PageMap, CopiesWithoutReadingPagesThatNobodyHasUsed) {
    const PageMap map;
    UnsetArray<float> array = zero_array<float>(size_t{2} << 20);
    ASSERT_TRUE(PageMap::can_look_at(array));
    const std::span<const float> values = array;
    if (map.look_at(values).all()) GTEST_SKIP() << "the system does not tell of pages";
    const size_t page = static_cast<size_t>(sysconf(_SC_PAGESIZE)) / sizeof(float);
    array[3 * page - 1] = 1;
    array[5 * page] = 2;

    const std::span<const float> part = values.subspan(page / 2, 6 * page);
    UnsetArray<float> copy(part.size(), -1.0f);
    map.look_at(part).copy(part, copy.data());
    EXPECT_EQ(copy[2 * page + page / 2 - 1], 1);
    EXPECT_EQ(copy[4 * page + page / 2], 2);
    EXPECT_EQ(std::count(copy.begin(), copy.end(), 0.0f), static_cast<ptrdiff_t>(copy.size() - 2));

    EXPECT_FALSE(map.look_at(values.subspan(0, page)).all()) << "the copy has read it";
    EXPECT_TRUE(map.look_at(values.subspan(2 * page, page)).all());
    EXPECT_TRUE(map.look_at(values.subspan(5 * page, 1)).all());
    EXPECT_FALSE(map.look_at(values.subspan(5 * page, 2 * page)).all());
}

TEST(PageMap, PagesThatWereLookedAtAreCopiedWhole) {
    UnsetArray<float> array(size_t{2} << 20);
    for (size_t i = 0; i < array.size(); ++i)
        array[i] = static_cast<float>(i);
    const UsedPages used = PageMap().look_at(array);
    EXPECT_TRUE(used.all());
    UnsetArray<float> copy(array.size());
    used.copy(array, copy.data());
    EXPECT_EQ(copy, array);
}

TEST(PageMap, LooksAtLargeArraysOnly) {
    EXPECT_FALSE(PageMap::can_look_at(zero_array<float>(1000)));
    EXPECT_TRUE(PageMap().look_at({}).all());
}

}  // namespace
}  // namespace obscura
