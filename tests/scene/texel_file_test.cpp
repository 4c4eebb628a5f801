// tests/scene/texel_file_test.cpp - texels in files: whole ones are known, and appear in memory.
// SPDX-License-Identifier: Apache-2.0
#include "scene/texel_file.h"

#include "scene/mapped_texels.h"

#include <gtest/gtest.h>

#include "support/temp_folder.h"
#include <chrono>
#include <cstdio>
#include <fstream>
#include <numeric>
#include <thread>
#include <vector>

namespace obscura {
namespace {

constexpr TexelKey key = {0x1234, 0x5678};

std::vector<uint32_t> numbers(size_t count) {
    std::vector<uint32_t> out(count);
    std::iota(out.begin(), out.end(), 7U);
    return out;
}

class TexelFiles : public testing::Test {
protected:
    std::filesystem::path file() const { return texel_file(folder_.path() / "made", key); }

    TempFolder folder_;
};

TEST_F(TexelFiles, AreKnownWhenTheyAreWhole) {
    EXPECT_EQ(file().filename(), "0000000000001234-0000000000005678.texels");
    EXPECT_FALSE(has_texels(file(), key, 3000));
    ASSERT_TRUE(write_texel_file(file(), key, numbers(3000)));
    EXPECT_TRUE(has_texels(file(), key, 3000));
    EXPECT_FALSE(has_texels(file(), key, 2999));
    EXPECT_FALSE(has_texels(file(), {0x1234, 0x5679}, 3000));
    std::filesystem::resize_file(file(), std::filesystem::file_size(file()) - 4);
    EXPECT_FALSE(has_texels(file(), key, 3000));
    EXPECT_FALSE(has_texels(file(), key, 2999)) << "its head says how many there were";
}

TEST_F(TexelFiles, AppearWhereTheyAreMapped) {
    ASSERT_TRUE(write_texel_file(file(), key, numbers(3000)));
    constexpr size_t page = MappedTexels::texels_per_page;
    const auto mapped = MappedTexels::reserve(8 * page, 1U << 30);
    ASSERT_TRUE(mapped);
    EXPECT_EQ((*mapped)->size(), 8 * page);
    ASSERT_TRUE((*mapped)->map(page, 3000, file(), texel_file_head));
    const Result<uint32_t*> memory = (*mapped)->memory(5 * page, page);
    ASSERT_TRUE(memory);
    (*memory)[3] = 99;
    std::filesystem::remove(file());
    const uint32_t* const texels = (*mapped)->data();
    EXPECT_EQ(texels[page], 7U);
    EXPECT_EQ(texels[page + 2999], 3006U);
    EXPECT_EQ(texels[5 * page + 3], 99U);
    const Result<void> missing = (*mapped)->map(0, page, file(), texel_file_head);
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().id, "E-RES-MISSING");
}

/// Bytes of files in the process's memory.
size_t resident() {
    std::ifstream statm("/proc/self/statm");
    size_t all = 0;
    size_t own = 0;
    size_t of_files = 0;
    statm >> all >> own >> of_files;
    return of_files * 4096;
}

TEST_F(TexelFiles, GiveTheirMemoryBackWhereTheyTakeTooMuch) {
    constexpr size_t count = size_t{16} << 20;  // 64 MiB
    constexpr size_t most = size_t{8} << 20;
    ASSERT_TRUE(write_texel_file(file(), key, numbers(count)));
    const auto mapped = MappedTexels::reserve(count, most);
    ASSERT_TRUE(mapped);
    ASSERT_TRUE((*mapped)->map(0, count, file(), texel_file_head));
    const size_t before = resident();
    const auto sum_of = [&] {
        uint64_t sum = 0;
        for (size_t i = 0; i < count; i += MappedTexels::texels_per_page)
            sum += (*mapped)->data()[i];
        return sum;
    };
    const uint64_t sum = sum_of();
    const auto is_small = [&] { return resident() < before + most + (size_t{4} << 20); };
    for (int tries = 0; tries < 500 && !is_small(); ++tries)
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_TRUE(is_small()) << resident() << " from " << before;
    EXPECT_EQ(sum_of(), sum) << "they come again";
}

}  // namespace
}  // namespace obscura
