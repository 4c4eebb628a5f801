// tests/base/json_read_test.cpp - which values are accepted as numbers, and where faults are.
// SPDX-License-Identifier: Apache-2.0
#include "base/json/json_read.h"

#include <gtest/gtest.h>

namespace obscura {
namespace {

using nlohmann::json;

/// Reads member "x" of {"x": value}; returns the fault, if any, as "id place".
template <typename Body>
std::string fault_of(const std::string& value, const Body& body) {
    const json tree = json::parse("{\"x\":" + value + "}");
    JsonFault fault;
    fault.file = "f";
    body(JsonReader(tree, "/deep", fault));
    return fault.error ? fault.error->id + " " + fault.error->where : "";
}

TEST(JsonRead, IntegersMayBeWrittenInAnyWay) {  // B7
    for (const char* text : {"3", "3.0", "3e0", "0.3e1", "30e-1"}) {
        uint64_t size = 0;
        int index = 0;
        EXPECT_EQ(fault_of(text, [&](const JsonReader& r) { size = r.size("x", 7); }), "");
        EXPECT_EQ(fault_of(text, [&](const JsonReader& r) { index = r.index("x", 4, "y"); }), "");
        EXPECT_EQ(size, 3U) << text;
        EXPECT_EQ(index, 3) << text;
    }
    uint64_t large = 0;
    EXPECT_EQ(fault_of("9007199254740992", [&](const auto& r) { large = r.size("x", 0); }), "");
    EXPECT_EQ(large, 9007199254740992U);
}

TEST(JsonRead, OtherNumbersAreNoIntegers) {  // B8
    for (const char* text :
         {"3.5", "-1", "-0.5", "9007199254740994", "1e17", "18446744073709551615", "1e300"}) {
        EXPECT_EQ(fault_of(text, [](const auto& r) { r.size("x", 0); }), "E-JSON-TYPE f#/deep/x")
            << text;
        EXPECT_NE(fault_of(text, [](const auto& r) { r.index("x", 1U << 30, "y"); }), "") << text;
    }
}

TEST(JsonRead, IndicesStayBelowTheCount) {
    EXPECT_EQ(fault_of("4", [](const auto& r) { r.index("x", 4, "y"); }), "E-DOC-INDEX f#/deep/x");
    EXPECT_EQ(fault_of("2147483648", [](const auto& r) { r.index("x", 1ULL << 40, "y"); }),
              "E-DOC-INDEX f#/deep/x");
    EXPECT_EQ(fault_of("[0,1,5]", [](const auto& r) { r.indices("x", 5, "y"); }),
              "E-DOC-INDEX f#/deep/x");
    EXPECT_EQ(fault_of("[0,1,4]", [](const auto& r) { r.indices("x", 5, "y"); }), "");
}

TEST(JsonRead, WrongTypesAreFaults) {  // B9
    const std::string expected = "E-JSON-TYPE f#/deep/x";
    for (const char* text : {"null", "\"a\"", "true", "[]", "{}"}) {
        EXPECT_EQ(fault_of(text, [](const auto& r) { r.number("x", 0); }), expected) << text;
        EXPECT_EQ(fault_of(text, [](const auto& r) { r.size("x", 0); }), expected) << text;
    }
    EXPECT_EQ(fault_of("1", [](const auto& r) { r.text("x"); }), expected);
    EXPECT_EQ(fault_of("1", [](const auto& r) { r.boolean("x", false); }), expected);
    EXPECT_EQ(fault_of("1", [](const auto& r) { r.count("x"); }), expected);
    EXPECT_EQ(fault_of("1", [](const auto& r) { r.child("x"); }), expected);
    EXPECT_EQ(fault_of("{}", [](const auto& r) { r.texts("x"); }), expected);
    EXPECT_EQ(fault_of("[1]", [](const auto& r) { r.texts("x"); }), expected);
    EXPECT_EQ(fault_of("{}", [](const auto& r) { r.indices("x", 9, "y"); }), expected);
    EXPECT_EQ(fault_of("[3]", [](const auto& r) { r.each("x", [](const auto&, size_t) {}); }),
              "E-JSON-TYPE f#/deep/x/0");
}

TEST(JsonRead, ArraysOfNumbersHaveTheirLength) {
    std::array<double, 3> out = {7, 8, 9};
    const auto read = [&](const JsonReader& r) { r.numbers("x", out); };
    for (const char* text : {"[1,2]", "[1,2,3,4]", "[1,2,\"3\"]", "1", "null"}) {
        EXPECT_EQ(fault_of(text, read), "E-JSON-TYPE f#/deep/x") << text;
        EXPECT_EQ(out, (std::array<double, 3>{7, 8, 9})) << text;
    }
    EXPECT_EQ(fault_of("[1,2.5,-3]", read), "");
    EXPECT_EQ(out, (std::array<double, 3>{1, 2.5, -3}));
}

TEST(JsonRead, OnlyTheFirstFaultIsKept) {
    const std::string fault = fault_of("1", [](const JsonReader& r) {
        r.text("x");
        r.require("y");
    });
    EXPECT_EQ(fault, "E-JSON-TYPE f#/deep/x");
}

TEST(JsonRead, PointersEscapeTheirKeys) {
    const json tree = {{"a/b~c", 1}};
    JsonFault fault;
    JsonReader(tree, "", fault).text("a/b~c");
    ASSERT_TRUE(fault.error);
    EXPECT_EQ(fault.error->where, "#/a~1b~0c");
}

TEST(JsonRead, AbsentMembersGiveTheFallback) {
    const json tree = json::object();
    JsonFault fault;
    const JsonReader reader(tree, "", fault);
    EXPECT_EQ(reader.number("x", 4.5), 4.5);
    EXPECT_EQ(reader.size("x", 6), 6U);
    EXPECT_EQ(reader.index("x", 3, "y"), -1);
    EXPECT_EQ(reader.text("x", "z"), "z");
    EXPECT_FALSE(reader.extension("E").has("x"));
    EXPECT_FALSE(reader.has_extension("E"));
    EXPECT_FALSE(fault.error);
}

}  // namespace
}  // namespace obscura
