// tests/app/crosscheck_request_test.cpp - the options of crosscheck: counts, rays and combinations.
// SPDX-License-Identifier: Apache-2.0
#include "app/crosscheck_request.h"

#include <gtest/gtest.h>

namespace obscura::app {
namespace {

TEST(CrosscheckRequest, CountsTakeSuffixes) {
    EXPECT_EQ(*parse_count("7", "--rays"), 7U);
    EXPECT_EQ(*parse_count("250k", "--rays"), 250000U);
    EXPECT_EQ(*parse_count("10M", "--rays"), 10000000U);
    EXPECT_EQ(*parse_count("2G", "--rays"), 2000000000U);
    for (const char* text : {"", "k", "1.5M", "-3", "10m", "10MM", "1e6", " 7"}) {
        const auto count = parse_count(text, "--rays");
        ASSERT_FALSE(count.has_value()) << text;
        EXPECT_EQ(count.error().id, "E-USAGE-NUMBER") << text;
    }
    for (const char* text : {"0", "0M", "1001G", "18446744073709551615k"}) {
        const auto count = parse_count(text, "--rays");
        ASSERT_FALSE(count.has_value()) << text;
        EXPECT_EQ(count.error().id, "E-USAGE-RANGE") << text;
    }
}

CrosscheckArguments one_scene() {
    CrosscheckArguments arguments;
    arguments.scenes = {"a.glb"};
    return arguments;
}

TEST(CrosscheckRequest, ReadsARay) {
    CrosscheckArguments arguments = one_scene();
    arguments.ray = "1,2,3,0,-1,0.5";
    const auto request = make_crosscheck_request(arguments);
    ASSERT_TRUE(request.has_value());
    EXPECT_EQ(request->ray->origin.y, 2);
    EXPECT_EQ(request->ray->direction.z, 0.5);
    EXPECT_EQ(request->rays, 1000000U);
    arguments.ray = "1,2,3,0,0,0";
    EXPECT_EQ(make_crosscheck_request(arguments).error().id, "E-USAGE-RANGE");
    arguments.ray = "1,2,3";
    EXPECT_FALSE(make_crosscheck_request(arguments).has_value());
}

TEST(CrosscheckRequest, RefusesCombinations) {
    CrosscheckArguments two = one_scene();
    two.scenes.emplace_back("b.glb");
    two.image = "x.png";
    EXPECT_EQ(make_crosscheck_request(two).error().id, "E-USAGE-CONFLICT");
    CrosscheckArguments both = one_scene();
    both.assets = "folder";
    EXPECT_EQ(make_crosscheck_request(both).error().id, "E-USAGE-CONFLICT");
    CrosscheckArguments ray_and_file = one_scene();
    ray_and_file.ray = "0,0,0,1,0,0";
    ray_and_file.json = "x.json";
    EXPECT_EQ(make_crosscheck_request(ray_and_file).error().id, "E-USAGE-CONFLICT");
}

}  // namespace
}  // namespace obscura::app
