// tests/gltf/value_reader_test.cpp - values that tinygltf's Value drops are read all the same.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/value_reader.h"

#include "gltf/values.h"

#include <gtest/gtest.h>

namespace obscura::gltf {
namespace {

using nlohmann::json;
using test::value_of;

/// A reader's fault about the member "x"; empty: none.
template <typename Read>
std::string fault_of(const char* text, const Read& read) {
    JsonFault fault;
    fault.file = "f";
    const tinygltf::Value value = value_of(json::parse(text));
    read(ValueReader(value, "/at", fault));
    return fault.error ? fault.error->where + " " + fault.error->message : "";
}

TEST(ValueReader, NullAndWhatIsEmptyAreNotAbsent) {
    const auto number = [](const ValueReader& r) { r.number("x", 1); };
    EXPECT_EQ(fault_of(R"({"x": null})", number), "f#/at/x this is null; it must be a number");
    EXPECT_EQ(fault_of(R"({"x": []})", number),
              "f#/at/x this is an array of 0; it must be a number");
    EXPECT_EQ(fault_of(R"({"x": {}})", number), "f#/at/x this is an object; it must be a number");
    EXPECT_EQ(fault_of(R"({"y": null})", number), "");
}

TEST(ValueReader, ElementsKeepTheirNumbers) {
    JsonFault fault;
    const tinygltf::Value value = value_of(json::parse(R"({"x": [{}, {"y": 5}, {}]})"));
    const ValueReader reader(value, "", fault);
    EXPECT_EQ(reader.count("x"), 3U);
    std::vector<uint64_t> found;
    reader.each("x", [&](const ValueReader& r, size_t) { found.push_back(r.size("y", 0)); });
    EXPECT_EQ(found, (std::vector<uint64_t>{0, 5, 0}));
    EXPECT_FALSE(fault.error);
}

TEST(ValueReader, TextsThatLookLikeMarksAreTexts) {
    for (const char* text : {"\x01n", "\x01[", "\x01", "\x01\x01n", ""}) {
        JsonFault fault;
        const tinygltf::Value value = value_of({{"x", text}, {"y", 1}});
        EXPECT_EQ(ValueReader(value, "", fault).text("x", "none"), text);
        EXPECT_FALSE(fault.error);
    }
}

TEST(ValueReader, IntegersBeyond32BitsAreNotWrapped) {
    JsonFault fault;
    const tinygltf::Value value =
        value_of({{"a", 4294967297U}, {"b", 9007199254740992U}, {"c", 3.0}, {"d", -5}});
    const ValueReader reader(value, "", fault);
    EXPECT_EQ(reader.size("a", 0), 4294967297U);
    EXPECT_EQ(reader.size("b", 0), 9007199254740992U);
    EXPECT_EQ(reader.index("c", 4, "thing"), 3);
    EXPECT_EQ(reader.number("d", 0), -5);
    EXPECT_FALSE(fault.error);
    reader.index("d", 4, "thing");
    EXPECT_EQ(fault.error->id, "E-JSON-TYPE");
}

}  // namespace
}  // namespace obscura::gltf
