// tests/base/json_text_test.cpp - JSON text, its limits and the positions of its errors.
// SPDX-License-Identifier: Apache-2.0
#include "base/json/json_text.h"

#include <gtest/gtest.h>

namespace obscura {
namespace {

using nlohmann::json;

struct Parsed {
    Result<json> tree;
    std::vector<std::string> warnings;
};

Parsed parse(const std::string& text) {
    Log log(Verbosity::quiet);
    Result<json> tree = parse_json_text(text, "a.gltf", log);
    return {std::move(tree), log.warnings()};
}

std::string id_of(const std::string& text) {
    const Parsed parsed = parse(text);
    if (parsed.tree) return "";
    EXPECT_EQ(parsed.tree.error().code, ExitCode::bad_data);
    EXPECT_EQ(parsed.tree.error().where, "a.gltf");
    return parsed.tree.error().id;
}

std::string nested(size_t depth) {
    return "{\"a\":" + std::string(depth - 1, '[') + std::string(depth - 1, ']') + "}";
}

TEST(JsonText, KeepsEveryKindOfValue) {
    const std::string text =
        R"({"a":[1,-2,2.5,true,false,null,"x\u00e9\ud83d\ude00"],"b":{"c":{}},"d":[[],[{}]]})";
    const Parsed parsed = parse(text);
    ASSERT_TRUE(parsed.tree);
    EXPECT_EQ(*parsed.tree, json::parse(text));
    EXPECT_TRUE(parsed.warnings.empty());
}

TEST(JsonText, SyntaxErrorsTellLineAndColumn) {  // B1
    const Parsed parsed = parse("{\n  \"a\": 1,\n  \"b\" 2\n}");
    ASSERT_FALSE(parsed.tree);
    EXPECT_EQ(parsed.tree.error().id, "E-JSON-SYNTAX");
    EXPECT_EQ(parsed.tree.error().message.substr(0, 17), "line 3, column 7:");
}

TEST(JsonText, RefusesWhatIsNotJson) {
    for (const char* text : {"",
                             "{",
                             "{\"a\":[1,2}",
                             "{} x",              // B1 trailing garbage
                             "{\"a\":NaN}",       // B5
                             "{\"a\":Infinity}",  // B5
                             "{\"a\":1e999}",     // B5
                             "{\"a\":-1e999}",    // B5
                             "{\"a\":01}",
                             "{\"a\":\"\xFF\"}",  // B3
                             "{\"a\":\"\xC0\x80\"}",
                             "{\"a\":\"\xED\xA0\x80\"}",
                             "{\"a\":\"tab\there\"}",
                             "{'a':1}",
                             "{\"a\":1,}",
                             "{\"a\":1 /* b */}"}) {
        EXPECT_EQ(id_of(text), "E-JSON-SYNTAX") << text;
    }
    for (const char* text : {"[]", "1", "\"a\"", "null"}) {
        EXPECT_EQ(id_of(text), "E-JSON-ROOT") << text;
    }
}

TEST(JsonText, HugeNumbersAreNamedAsSuch) {
    EXPECT_NE(parse("{\"a\":1e999}").tree.error().message.find("too large"), std::string::npos);
}

TEST(JsonText, DepthIsLimitedForAnyDepth) {  // B4
    EXPECT_EQ(id_of(nested(128)), "");
    for (const size_t depth : {129U, 1000U, 100000U, 1000000U}) {
        EXPECT_EQ(id_of(nested(depth)), "E-JSON-DEPTH") << depth;
        EXPECT_EQ(id_of("{\"a\":" + std::string(depth, '[')), "E-JSON-DEPTH") << depth;
    }
}

TEST(JsonText, ByteOrderMarkWarns) {  // B2
    const Parsed parsed = parse("\xEF\xBB\xBF{\"a\":1}");
    ASSERT_TRUE(parsed.tree);
    EXPECT_EQ((*parsed.tree)["a"], 1);
    ASSERT_EQ(parsed.warnings.size(), 1U);
    EXPECT_NE(parsed.warnings[0].find("byte order mark"), std::string::npos);
}

TEST(JsonText, LastOfRepeatedKeysCountsAndWarns) {  // B6
    const Parsed parsed = parse(R"({"a":1,"b":{"a":5},"a":{"x":2},"c":[{"a":1}]})");
    ASSERT_TRUE(parsed.tree);
    EXPECT_EQ((*parsed.tree)["a"]["x"], 2);
    EXPECT_EQ((*parsed.tree)["b"]["a"], 5);
    ASSERT_EQ(parsed.warnings.size(), 1U);
    EXPECT_NE(parsed.warnings[0].find("\"a\" occurs twice"), std::string::npos);
}

TEST(JsonText, ManyKeysAndElementsAreLinear) {  // B11
    std::string text = "{\"k\":[0";
    for (int i = 0; i < 300000; ++i)
        text += ",1";
    text += "]";
    for (int i = 0; i < 100000; ++i)
        text += ",\"key" + std::to_string(i) + "\":0";
    const Parsed parsed = parse(text + "}");
    ASSERT_TRUE(parsed.tree);
    EXPECT_EQ(parsed.tree->size(), 100001U);
}

}  // namespace
}  // namespace obscura
