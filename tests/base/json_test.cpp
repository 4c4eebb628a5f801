// tests/base/json_test.cpp - JSON text: nesting, order, escapes, numbers.
// SPDX-License-Identifier: Apache-2.0
#include "base/json/json.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <locale>

namespace obscura {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(JsonDocument, NestsAndKeepsTheOrder) {
    Json json;
    json["z"] = 1;
    json["b"] = Json::array({"x", Json::object(), Json::array()});
    json["a"] = true;
    EXPECT_EQ(json_document(json),
              "{\n  \"z\": 1,\n  \"b\": [\n    \"x\",\n    {},\n    []\n  ],\n  \"a\": true\n}\n");
}

TEST(JsonDocument, EscapesWhatJsonForbids) {
    EXPECT_EQ(json_document(std::string("a\"b\\c\n\t\x01")), "\"a\\\"b\\\\c\\n\\t\\u0001\"\n");
    EXPECT_EQ(json_document(std::string("nul") + '\0' + "!"), "\"nul\\u0000!\"\n");
}

/// Those that JSON allows in strings, but terminals act on.
TEST(JsonDocument, EscapesTheOtherControlsToo) {
    const std::string text = "a\x7F\xC2\x80\xC2\x9F\xC2\xA0\xC3\x80";
    const std::string document = json_document(text);
    EXPECT_EQ(document, "\"a\\u007f\\u0080\\u009f\xC2\xA0\xC3\x80\"\n");
    EXPECT_EQ(Json::parse(document).get<std::string>(), text);
}

TEST(JsonDocument, KeepsGoodUtf8AndReplacesTheRest) {
    const std::string good = "\xC3\xA9 \xE2\x82\xAC \xF0\x9F\x98\x80";
    EXPECT_EQ(json_document(good), "\"" + good + "\"\n");
    for (const char* bad : {"\xFF", "\xC3(", "\xE2\x82", "\xC0\xAF", "\xED\xA0\x80"}) {
        const std::string text = json_document(std::string(bad));
        EXPECT_NE(text.find("\xEF\xBF\xBD"), std::string::npos) << text;
        EXPECT_FALSE(Json::parse(text, nullptr, false).is_discarded()) << text;
    }
}

TEST(JsonDocument, NumbersReadBackTheSame) {
    for (const double number : {0.1, 1.0, -0.0, 1e300, 5e-324, 1.0 / 3, 123456789.123456789}) {
        const auto back = Json::parse(json_document(number)).get<double>();
        EXPECT_EQ(back, number);
        EXPECT_EQ(std::signbit(back), std::signbit(number));
    }
    EXPECT_EQ(json_document(0.1), "0.1\n");
    EXPECT_EQ(json_document(std::numeric_limits<uint64_t>::max()), "18446744073709551615\n");
    EXPECT_EQ(json_document(std::numeric_limits<int64_t>::min()), "-9223372036854775808\n");
    EXPECT_EQ(json_document(static_cast<double>(NAN)), "null\n");
    EXPECT_EQ(json_document(-infinity), "null\n");
}

/// Writes 1234.5 as 1.234,5.
struct CommaPoint : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
};

TEST(JsonDocument, IsTheSameInEveryLocale) {
    const std::locale before = std::locale::global(std::locale(std::locale(), new CommaPoint));
    EXPECT_EQ(json_document(1234.5), "1234.5\n");
    EXPECT_EQ(json_document(1234567), "1234567\n");
    std::locale::global(before);
}

}  // namespace
}  // namespace obscura
