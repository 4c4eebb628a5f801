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

/// Renderings of which other parts make some must not have one file.
TEST(ImageNames, ShapesTellWhichNamesMayBeEqual) {
    const auto shape = [](const char* pattern, const char* asset) {
        NameFields fields;
        fields.asset = asset;
        return NameShape(pattern, fields);
    };
    const auto meet = [&](const char* a, const char* b, const char* pattern) {
        const bool one = shape(pattern, a).may_equal(shape(pattern, b));
        EXPECT_EQ(one, shape(pattern, b).may_equal(shape(pattern, a)));
        return one;
    };
    EXPECT_TRUE(meet("shoe", "shoe_kids", "out/{asset}_{variant}.png"));
    EXPECT_FALSE(meet("shoe", "boot", "out/{asset}_{variant}.png"));
    EXPECT_FALSE(meet("shoe", "shoe_kids", "out/{asset}/{variant}.png"));
    EXPECT_FALSE(meet("shoe", "shoe_kids", "{variant}/{asset}/{frame:04}.png"));
    EXPECT_FALSE(meet("shoe", "kids_shoe", "{asset}.####.png"));
    EXPECT_TRUE(meet("shoe", "kids_shoe", "{view}_{asset}.png"));
    EXPECT_FALSE(meet("shoe", "kids_boot", "{view}_{asset}.png"));
    EXPECT_TRUE(meet("shoe", "shoe.1", "{asset}.####.png"));
    EXPECT_TRUE(shape("a.1.png", "shoe").may_equal(shape("a.#.png", "boot")));
    EXPECT_FALSE(shape("a.png", "shoe").may_equal(shape("a.#.png", "boot")));
    EXPECT_TRUE(shape("./x/../{asset}.png", "shoe").may_equal(shape("shoe.png", "boot")));
}

}  // namespace
}  // namespace obscura
