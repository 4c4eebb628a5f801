// tests/layout/table_words_test.cpp - table words read by number are found, and nothing else.
// SPDX-License-Identifier: Apache-2.0
#include "layout/table_words.h"

#include <gtest/gtest.h>

namespace obscura::layout {
namespace {

TEST(TableWords, NumbersAreRefused) {
    for (const char* line : {"const LanesI node = primitive.integer(14);",
                             "Lanes metallic = g.material.number( 4);",
                             "const Four<F> a = record.four_numbers(12);",
                             "record.one_integer(3 + k)",
                             "s.emission = read3(g.material, 8);",
                             "maps{read_affine(record, 12)}",
                             "return {read(1), read(2), read(3)};",
                             "q.k[i] = read(7 + i);",
                             "Lanes radius = words(4);"}) {
        EXPECT_EQ(check_table_words("stages/x.cpp", line).size(), 1U) << line;
    }
}

TEST(TableWords, NamesAndOtherCallsAreFine) {
    for (const char* line : {"record.integer<&Primitive::uv_base>(0)",
                             "record.number<&ShapeRecord::size>(2)",
                             "record.four_numbers<slot, matrix>(2)",
                             "reader.number(\"fov\", 1)",
                             "json.integer(name, 3)",
                             "bits.read(5)",
                             "thread(1)"}) {
        EXPECT_EQ(check_table_words("stages/x.cpp", line).size(), 0U) << line;
    }
}

TEST(TableWords, TheLineIsNamed) {
    const Problems found = check_table_words("stages/x.cpp", "a;\nb = record.number(5);\n");
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].rfind("stages/x.cpp:2: `.number(5`", 0), 0U) << found[0];
}

}  // namespace
}  // namespace obscura::layout
