// gltf/parse/value_reader.cpp - checked reading of extensions from tinygltf's values.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/value_reader.h"

#include <nlohmann/json.hpp>

namespace obscura::gltf {

namespace {

using nlohmann::json;

// Texts that stand for members that a tinygltf::Value cannot hold. A text of the file that begins
// with the same character gets one more of it in front.
constexpr char mark = '\x01';
constexpr std::string_view null_mark = "\x01n";
constexpr std::string_view array_mark = "\x01[";
constexpr std::string_view object_mark = "\x01{";

const std::string* text_in(const tinygltf::Value& value) {
    return value.IsString() ? &value.Get<std::string>() : nullptr;
}

bool is_marked(const tinygltf::Value& value, std::string_view as) {
    const std::string* text = text_in(value);
    return text != nullptr && *text == as;
}

void mark_number(json& number) {
    const bool fits = number.is_number_unsigned() ? number.get<uint64_t>() <= INT32_MAX
                                                  : number.get<int64_t>() >= INT32_MIN;
    if (!fits) number = number.get<double>();
}

}  // namespace

void mark_for_values(json& tree) {
    if (tree.is_number_integer()) {
        mark_number(tree);
    } else if (tree.is_null()) {
        tree = null_mark;
    } else if (tree.is_string()) {
        auto& text = tree.get_ref<std::string&>();
        if (!text.empty() && text.front() == mark) text.insert(text.begin(), mark);
    } else if (tree.is_structured() && tree.empty()) {
        tree = tree.is_array() ? array_mark : object_mark;
    } else if (tree.is_structured()) {
        for (json& element : tree)
            mark_for_values(element);
    }
}

JsonKind ValueTree::kind(const Value& value) {
    switch (value.Type()) {
        case tinygltf::BOOL_TYPE:
            return JsonKind::boolean;
        case tinygltf::INT_TYPE:
        case tinygltf::REAL_TYPE:
            return JsonKind::number;
        case tinygltf::ARRAY_TYPE:
            return JsonKind::array;
        case tinygltf::OBJECT_TYPE:
            return JsonKind::object;
        default:
            break;
    }
    if (is_marked(value, array_mark)) return JsonKind::array;
    if (is_marked(value, object_mark)) return JsonKind::object;
    return value.IsString() && !is_marked(value, null_mark) ? JsonKind::text : JsonKind::null;
}

std::optional<uint64_t> ValueTree::integer(const Value& value) {
    return value.IsNumber() ? json_integer(number(value)) : std::nullopt;
}

std::string ValueTree::number_text(const Value& value) {
    return value.IsInt() ? std::to_string(value.Get<int>()) : json(number(value)).dump();
}

std::string_view ValueTree::text(const Value& value) {
    std::string_view text = value.Get<std::string>();
    if (!text.empty() && text.front() == mark) text.remove_prefix(1);
    return text;
}

const ValueTree::Value::Array& ValueTree::array(const Value& value) {
    static const Value::Array empty;
    return value.IsArray() ? value.Get<Value::Array>() : empty;
}

const ValueTree::Object& ValueTree::object(const Value& value) {
    static const Object empty;
    return value.IsObject() ? value.Get<Object>() : empty;
}

const ValueTree::Value* ValueTree::find(const Object& object, std::string_view key) {
    const auto found = object.find(std::string(key));
    return found == object.end() ? nullptr : &found->second;
}

}  // namespace obscura::gltf

namespace obscura {
template class ObjectReader<gltf::ValueTree>;
}  // namespace obscura
