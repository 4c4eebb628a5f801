// tests/serve/guarded_test.cpp - exceptions end neither a thread nor the server.
// SPDX-License-Identifier: Apache-2.0
#include "serve/guarded.h"

#include <gtest/gtest.h>

#include "serve/beside.h"
#include <stdexcept>

namespace obscura::serve {
namespace {

TEST(Guarded, ExceptionsBecomeErrors) {
    const auto id_of = [](const auto& body) {
        const Result<int> result = guarded<int>(body);
        return result ? std::to_string(*result) : result.error().id;
    };
    EXPECT_EQ(id_of([]() -> Result<int> { return 7; }), "7");
    EXPECT_EQ(id_of([]() -> Result<int> { throw std::bad_alloc(); }), "E-MEM");
    EXPECT_EQ(id_of([]() -> Result<int> { throw std::runtime_error("broken"); }), "E-INTERNAL");
}

TEST(Guarded, WorkBesideMayThrow) {
    std::atomic<bool> has_begun = false;
    {
        const Beside beside([&](const std::atomic<bool>&) {
            has_begun = true;
            throw std::runtime_error("broken");
        });
    }
    EXPECT_TRUE(has_begun);
}

}  // namespace
}  // namespace obscura::serve
