// tests/base/json_writer_test.cpp - JSON text: nesting, escapes, numbers.
// SPDX-License-Identifier: Apache-2.0
#include "base/json_writer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace obscura {
namespace {

template <typename T>
std::string alone(const T& value) {
    JsonWriter json;
    json.value(value);
    return std::move(json).take();
}

TEST(JsonWriter, NestsObjectsAndArrays) {
    JsonWriter json;
    json.begin_object().member("a", 1).key("b").begin_array();
    json.value("x").begin_object().end_object().begin_array().end_array();
    json.end_array().member("c", true).end_object();
    EXPECT_EQ(std::move(json).take(),
              "{\n  \"a\": 1,\n  \"b\": [\n    \"x\",\n    {},\n    []\n  ],\n  \"c\": true\n}\n");
}

TEST(JsonWriter, EscapesWhatJsonForbids) {
    EXPECT_EQ(alone(std::string("a\"b\\c\n\t\x01\x7f")), "\"a\\\"b\\\\c\\n\\t\\u0001\\u007f\"\n");
    EXPECT_EQ(alone(std::string("nul") + '\0' + "!"), "\"nul\\u0000!\"\n");
}

TEST(JsonWriter, KeepsGoodUtf8AndReplacesTheRest) {
    EXPECT_EQ(alone(std::string("\xC3\xA9 \xE2\x82\xAC \xF0\x9F\x98\x80")),
              "\"\xC3\xA9 \xE2\x82\xAC \xF0\x9F\x98\x80\"\n");
    const std::string bad = "\xEF\xBF\xBD";
    EXPECT_EQ(alone(std::string("\xFF")), "\"" + bad + "\"\n");
    EXPECT_EQ(alone(std::string("\xC3(")), "\"" + bad + "(\"\n");
    EXPECT_EQ(alone(std::string("\xE2\x82")), "\"" + bad + bad + "\"\n") << "cut short";
    EXPECT_EQ(alone(std::string("\xC0\xAF")), "\"" + bad + bad + "\"\n") << "overlong";
    EXPECT_EQ(alone(std::string("\xED\xA0\x80")), "\"" + bad + bad + bad + "\"\n") << "surrogate";
    EXPECT_EQ(alone(std::string("\xF4\x90\x80\x80")), "\"" + bad + bad + bad + bad + "\"\n");
}

TEST(JsonWriter, NumbersReadBackTheSame) {
    EXPECT_EQ(alone(0.1), "0.1\n");
    EXPECT_EQ(alone(1e300), "1e+300\n");
    EXPECT_EQ(alone(std::numeric_limits<uint64_t>::max()), "18446744073709551615\n");
    EXPECT_EQ(alone(std::numeric_limits<int64_t>::min()), "-9223372036854775808\n");
    EXPECT_EQ(alone(false), "false\n");
}

TEST(JsonWriter, NumbersThatJsonLacksAreNull) {
    EXPECT_EQ(alone(static_cast<double>(NAN)), "null\n");
    EXPECT_EQ(alone(-std::numeric_limits<double>::infinity()), "null\n");
}

}  // namespace
}  // namespace obscura
