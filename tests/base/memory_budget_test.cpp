// tests/base/memory_budget_test.cpp - charges fit or are refused, and are given back.
// SPDX-License-Identifier: Apache-2.0
#include "base/memory_budget.h"

#include <gtest/gtest.h>

#include <atomic>
#include <gmock/gmock.h>
#include <thread>
#include <vector>

namespace obscura {
namespace {

using testing::HasSubstr;

constexpr uint64_t mebibyte = 1U << 20;

class MemoryBudget : public testing::Test {
protected:
    /// A budget with so much room beside the program.
    static void leave(uint64_t bytes) { set_memory_limit(program_memory_bytes + bytes, "a test"); }
    ~MemoryBudget() override { remove_memory_limit(); }
};

TEST_F(MemoryBudget, TheLastCopyGivesBack) {
    leave(10 * mebibyte);
    auto first = charge_memory(MemoryUse::buffers, "a.bin", 6 * mebibyte);
    ASSERT_TRUE(first);
    EXPECT_EQ(first->bytes(), 6 * mebibyte);
    EXPECT_FALSE(charge_memory(MemoryUse::buffers, "b.bin", 5 * mebibyte));
    MemoryCharge copy = *first;
    first = MemoryCharge();
    EXPECT_FALSE(charge_memory(MemoryUse::buffers, "b.bin", 5 * mebibyte));
    copy = {};
    EXPECT_TRUE(charge_memory(MemoryUse::buffers, "b.bin", 10 * mebibyte));
    EXPECT_TRUE(charge_memory(MemoryUse::buffers, "b.bin", 10 * mebibyte)) << "was given back";
}

TEST_F(MemoryBudget, AChargeGrowsAndShrinks) {
    leave(10 * mebibyte);
    const auto bvh = charge_memory(MemoryUse::bvh, "", 0);
    ASSERT_TRUE(bvh);
    EXPECT_TRUE(bvh->change(8 * mebibyte));
    EXPECT_FALSE(bvh->change(3 * mebibyte));
    EXPECT_EQ(bvh->bytes(), 8 * mebibyte) << "what is refused is not counted";
    EXPECT_TRUE(bvh->change(-static_cast<int64_t>(4 * mebibyte)));
    EXPECT_TRUE(bvh->change(3 * mebibyte));
    EXPECT_TRUE(MemoryCharge().change(INT64_MAX)) << "an empty one counts nothing";
}

TEST_F(MemoryBudget, AMessageNamesTheLimitAndTheLargest) {
    leave(100 * mebibyte);
    const auto large = charge_memory(MemoryUse::textures, "b.png", 50 * mebibyte);
    const auto small = charge_memory(MemoryUse::textures, "a.png", 20 * mebibyte);
    const auto buffer = charge_memory(MemoryUse::buffers, "c.bin", 10 * mebibyte);
    const auto refused = charge_memory(MemoryUse::film, "size", 1500 * mebibyte);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ExitCode::out_of_memory);
    EXPECT_EQ(refused.error().id, "E-MEM");
    EXPECT_EQ(refused.error().where, "size");
    EXPECT_THAT(refused.error().message, HasSubstr("the film would take 1.5 GiB"));
    EXPECT_THAT(refused.error().message, HasSubstr("260 MiB, a test"));
    EXPECT_THAT(refused.error().message,
                HasSubstr("the program 160 MiB; textures 70 MiB, of which b.png 50 MiB; "
                          "buffers 10 MiB (c.bin)"));
}

TEST_F(MemoryBudget, HugeNumbersDoNotWrap) {
    EXPECT_FALSE(charge_memory(MemoryUse::buffers, "a", UINT64_MAX));
    leave(mebibyte);
    EXPECT_FALSE(charge_memory(MemoryUse::buffers, "a", INT64_MAX / 2));
    EXPECT_TRUE(charge_memory(MemoryUse::buffers, "a", mebibyte));
    set_memory_limit(program_memory_bytes - 1, "a test");
    EXPECT_FALSE(charge_memory(MemoryUse::program, "", 0)) << "the program itself does not fit";
}

TEST_F(MemoryBudget, ThreadsNeverExceedIt) {
    leave(1000);
    std::atomic<int> taken = 0;
    std::vector<std::thread> threads;
    const auto item = charge_memory(MemoryUse::bvh, "", 0);
    ASSERT_TRUE(item);
    for (int i = 0; i < 4; ++i) {
        threads.emplace_back([&] {
            for (int k = 0; k < 1000; ++k)
                taken += item->change(1) ? 1 : 0;
        });
    }
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(taken, 1000);
}

TEST(MemoryText, HasThreeUnits) {
    EXPECT_EQ(memory_text(312), "312 bytes");
    EXPECT_EQ(memory_text(25 * mebibyte), "25 MiB");
    EXPECT_EQ(memory_text(1638 * mebibyte), "1.6 GiB");
}

}  // namespace
}  // namespace obscura
