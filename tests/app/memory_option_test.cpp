// tests/app/memory_option_test.cpp - sizes of --max-memory, and the budget that they set.
// SPDX-License-Identifier: Apache-2.0
#include "app/memory_option.h"

#include "base/memory_budget.h"

#include <gtest/gtest.h>

namespace obscura::app {
namespace {

uint64_t bytes_of(const std::string& text) {
    const Result<MemorySize> size = parse_memory_size(text, "--max-memory");
    return size && size->percent == 0 ? size->bytes : 0;
}

TEST(MemoryOption, SizesHaveUnits) {
    EXPECT_EQ(bytes_of("512M"), uint64_t{512} << 20);
    EXPECT_EQ(bytes_of("4G"), uint64_t{4} << 30);
    EXPECT_EQ(bytes_of("1.5GiB"), uint64_t{3} << 29);
    EXPECT_EQ(bytes_of("2TB"), uint64_t{2} << 40);
    EXPECT_EQ(bytes_of("2048K"), uint64_t{2} << 20);
    EXPECT_EQ(bytes_of("3000000"), 3000000U);
    EXPECT_EQ(bytes_of("3000000B"), 3000000U);
    const Result<MemorySize> share = parse_memory_size("62.5%", "--max-memory");
    ASSERT_TRUE(share);
    EXPECT_EQ(share->percent, 62.5);
}

TEST(MemoryOption, OthersAreRefused) {
    for (const char* text : {"",
                             "G",
                             "4X",
                             "4 G",
                             "-4G",
                             "4GG",
                             "0",
                             "1K",
                             "0%",
                             "101%",
                             "%",
                             "1e9",
                             "nan",
                             "4iB",
                             "9999999999T"}) {
        const Result<MemorySize> size = parse_memory_size(text, "--max-memory");
        ASSERT_FALSE(size) << text;
        EXPECT_EQ(size.error().code, ExitCode::usage) << text;
        EXPECT_EQ(size.error().where, "--max-memory") << text;
    }
}

TEST(MemoryOption, TheDefaultIsFourFifths) {
    const uint64_t whole = program_memory_bytes + (uint64_t{40} << 20);  // 200 MiB
    ASSERT_TRUE(use_memory_limit({}, {whole, "a test"}));                // 160: no more
    EXPECT_FALSE(charge_memory(MemoryUse::film, "", 1));
    ASSERT_TRUE(use_memory_limit(MemorySize{0, 100}, {whole, "a test"}));
    EXPECT_TRUE(charge_memory(MemoryUse::film, "", uint64_t{40} << 20));
    const Result<void> small = use_memory_limit(MemorySize{1U << 20, 0}, {whole, "a test"});
    ASSERT_FALSE(small);
    EXPECT_EQ(small.error().message.find("the program would take 160 MiB, which does not fit"), 0U);
    ASSERT_TRUE(use_memory_limit({}, {}));
    EXPECT_TRUE(charge_memory(MemoryUse::film, "", uint64_t{1} << 50)) << "no limit is known";
    remove_memory_limit();
}

}  // namespace
}  // namespace obscura::app
