// base/json/json_read.cpp - typed and checked access to nlohmann-json's values.
// SPDX-License-Identifier: Apache-2.0
#include "base/json/json_read.h"

namespace obscura {

std::string json_pointer_part(std::string_view key) {
    std::string out = "/";
    for (const char c : key) {
        if (c == '~')
            out += "~0";
        else if (c == '/')
            out += "~1";
        else
            out += c;
    }
    return out;
}

JsonKind JsonTree::kind(const Value& value) {
    if (value.is_number()) return JsonKind::number;
    if (value.is_string()) return JsonKind::text;
    if (value.is_array()) return JsonKind::array;
    if (value.is_object()) return JsonKind::object;
    return value.is_boolean() ? JsonKind::boolean : JsonKind::null;
}

std::optional<uint64_t> JsonTree::integer(const Value& value) {
    if (!value.is_number()) return std::nullopt;
    if (value.is_number_unsigned()) {
        constexpr uint64_t largest = uint64_t{1} << 53;
        const uint64_t exact = value.get<uint64_t>();
        return exact <= largest ? std::optional(exact) : std::nullopt;
    }
    return json_integer(value.get<double>());
}

const JsonTree::Value* JsonTree::find(const Object& object, std::string_view key) {
    const auto found = object.find(key);
    return found == object.end() ? nullptr : &found->second;
}

template class ObjectReader<JsonTree>;

}  // namespace obscura
