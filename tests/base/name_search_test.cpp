// tests/base/name_search_test.cpp - patterns of names, and names that are near to others.
// SPDX-License-Identifier: Apache-2.0
#include "base/name_search.h"

#include <gtest/gtest.h>

namespace obscura {
namespace {

TEST(NameSearch, PatternsFitWholeNames) {
    EXPECT_TRUE(fits_pattern("Lamp", "Lamp"));
    EXPECT_FALSE(fits_pattern("Lamp", "lamp"));
    EXPECT_FALSE(fits_pattern("Lamp", "Lamp.001"));
    EXPECT_TRUE(fits_pattern("Lamp*", "Lamp.001"));
    EXPECT_TRUE(fits_pattern("Lamp*", "Lamp"));
    EXPECT_TRUE(fits_pattern("*", ""));
    EXPECT_FALSE(fits_pattern("?", ""));
    EXPECT_TRUE(fits_pattern("L?mp", "Lump"));
    EXPECT_FALSE(fits_pattern("L?mp", "Lmp"));
    EXPECT_TRUE(fits_pattern("[1]", "[1]"));  // brackets stand for themselves
}

TEST(NameSearch, AStarTakesAsMuchAsIsNeeded) {
    EXPECT_TRUE(fits_pattern("*ab*ab", "abcabab"));
    EXPECT_TRUE(fits_pattern("a*b*c", "a-b-b-c-c"));
    EXPECT_FALSE(fits_pattern("a*b*c", "a-c-b"));
    EXPECT_TRUE(fits_pattern("**x**", "x"));
    // Trying every way to share the letters among the stars would take ages.
    EXPECT_FALSE(fits_pattern("*a*a*a*a*a*a*a*a*b", std::string(10000, 'a')));
}

TEST(NameSearch, DistancesCountBytes) {
    EXPECT_EQ(edit_distance("", "abc"), 3U);
    EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);  // the textbooks' example
    EXPECT_EQ(edit_distance("same", "same"), 0U);
}

TEST(NameSearch, NearNamesComeFirstElseAll) {
    const std::vector<std::string> names = {"Key light", "Rim", "Key light", "Fill"};
    EXPECT_EQ(names_instead("key ligth", names, "lights"), " (did you mean 'Key light'?)");
    EXPECT_EQ(names_instead("light", names, "lights"), " (did you mean 'Key light'?)");
    EXPECT_EQ(names_instead("Rib", names, "lights"), " (did you mean 'Rim'?)");
    EXPECT_EQ(names_instead("Sun", names, "lights"), "; the lights are 'Key light', 'Rim', 'Fill'");
    EXPECT_EQ(names_instead("Sun", {}, "lights"), "; there are no lights");
    std::vector<std::string> many;
    for (char c = 'a'; c < 'l'; ++c)
        many.emplace_back(3, c);
    const std::string text = names_instead("Sunday", many, "nodes");
    EXPECT_NE(text.find("'hhh' and 3 more"), std::string::npos) << text;
}

TEST(NameSearch, EqualNamesGetNumbers) {
    using Names = std::vector<std::string>;
    EXPECT_EQ(distinct_names({"a", "b", "a", "a"}), (Names{"a", "b", "a-2", "a-3"}));
    EXPECT_EQ(distinct_names({"a", "a-2", "a"}), (Names{"a", "a-2", "a-3"}));
}

}  // namespace
}  // namespace obscura
