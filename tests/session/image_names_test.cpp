// tests/session/image_names_test.cpp - fields in the names of images' files.
// SPDX-License-Identifier: Apache-2.0
#include "session/image_names.h"

#include <gtest/gtest.h>

namespace obscura {
namespace {

const NameFields helmet = {"Helmet", "dark red", "front", 7};

TEST(ImageNames, FieldsAreReplaced) {
    EXPECT_EQ(name_by_pattern("out/{asset}/{variant}/{view}.{frame:04}.webp", helmet),
              "out/Helmet/dark red/front.0007.webp");
    EXPECT_EQ(name_by_pattern("{view}{view}.{frame}.exr", helmet), "frontfront.7.exr");
    EXPECT_EQ(name_by_pattern("{frame:0}.exr", helmet), "7.exr");
}

TEST(ImageNames, AllElseStays) {
    for (const char* name : {"a{b}.exr",
                             "{",
                             "}",
                             "{}",
                             "{view",
                             "{frame:x}",
                             "{frame:-1}",
                             "{view:2}",
                             "{frame:99}",
                             "a.####.exr"}) {
        EXPECT_EQ(name_by_pattern(name, helmet), name);
        EXPECT_FALSE(has_fields(name)) << name;
    }
    EXPECT_EQ(name_by_pattern("{{view}.exr", helmet), "{front.exr");
    EXPECT_TRUE(has_field("a/{frame:03}.png", "frame"));
    EXPECT_FALSE(has_field("a/{frame:03}.png", "view"));
}

TEST(ImageNames, TextsOfAssetsCannotLeaveTheirFolder) {
    EXPECT_EQ(name_by_pattern("out/{view}.png", {"", "", "../../etc/passwd", 1}),
              "out/_._.._etc_passwd.png");
    EXPECT_EQ(name_part(""), "_");
    EXPECT_EQ(name_part(".."), "_.");
    EXPECT_EQ(name_part("a\nb:c*?\"<>|\\"), "a_b_c_______");
    EXPECT_EQ(name_part("Größe {frame}"), "Größe _frame_");
}

TEST(ImageNames, EqualNamesGetNumbers) {
    using Names = std::vector<std::string>;
    EXPECT_EQ(distinct_names({"a", "b", "a", "a"}), (Names{"a", "b", "a-2", "a-3"}));
    EXPECT_EQ(distinct_names({"a", "a-2", "a"}), (Names{"a", "a-2", "a-3"}));
}

}  // namespace
}  // namespace obscura
