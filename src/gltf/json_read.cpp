// gltf/json_read.cpp - typed and checked access to JSON objects; the first fault is kept.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/json_read.h"

#include <cmath>
#include <utility>

namespace obscura {

namespace {

using nlohmann::json;

const json& empty_object() {
    static const json object = json::object();
    return object;
}

/// RFC 6901: ~ and / in a key are written ~0 and ~1.
std::string pointer_part(std::string_view key) {
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

std::string shown_value(const json& value) {
    if (value.is_array()) return "an array of " + std::to_string(value.size());
    if (value.is_object()) return "an object";
    if (value.is_null()) return "null";
    if (!value.is_string()) return value.dump();
    return "a string";
}

}  // namespace

JsonReader::JsonReader(const json& object, std::string pointer, JsonFault& fault)
    : object_(&object), pointer_(std::move(pointer)), fault_(&fault) {
    if (!object.is_object()) {
        wrong_type("", object, "an object");
        object_ = &empty_object();
    }
}

const json* JsonReader::find(std::string_view key) const {
    const auto found = object_->find(key);
    return found == object_->end() ? nullptr : &*found;
}

void JsonReader::fault(std::string_view key, const char* id, std::string message) const {
    if (fault_->error) return;
    const std::string place = key.empty() ? pointer_ : pointer_ + pointer_part(key);
    fault_->error = Error{ExitCode::bad_data, id, fault_->file + "#" + place, std::move(message)};
}

void JsonReader::wrong_type(std::string_view key, const json& value, const char* wanted) const {
    fault(key, "E-JSON-TYPE", "this is " + shown_value(value) + "; it must be " + wanted);
}

void JsonReader::require(std::string_view key) const {
    if (!has(key)) {
        fault("", "E-DOC-MISSING", "the member \"" + std::string(key) + "\" is required");
    }
}

double JsonReader::number(std::string_view key, double fallback) const {
    const json* value = find(key);
    if (value == nullptr) return fallback;
    if (value->is_number()) return value->get<double>();
    wrong_type(key, *value, "a number");
    return fallback;
}

bool JsonReader::boolean(std::string_view key, bool fallback) const {
    const json* value = find(key);
    if (value == nullptr) return fallback;
    if (value->is_boolean()) return value->get<bool>();
    wrong_type(key, *value, "true or false");
    return fallback;
}

std::string JsonReader::text(std::string_view key, std::string fallback) const {
    const json* value = find(key);
    if (value == nullptr) return fallback;
    if (value->is_string()) return value->get_ref<const std::string&>();
    wrong_type(key, *value, "a string");
    return fallback;
}

std::optional<uint64_t> JsonReader::integer(const json& value) {
    constexpr double largest = 9007199254740992.0;  // 2^53
    if (!value.is_number()) return std::nullopt;
    if (value.is_number_unsigned()) {
        const uint64_t exact = value.get<uint64_t>();
        return exact <= static_cast<uint64_t>(largest) ? std::optional(exact) : std::nullopt;
    }
    const double number = value.get<double>();
    if (!(number >= 0 && number <= largest) || number != std::floor(number)) return std::nullopt;
    return static_cast<uint64_t>(number);
}

uint64_t JsonReader::size(std::string_view key, uint64_t fallback) const {
    const json* value = find(key);
    if (value == nullptr) return fallback;
    const std::optional<uint64_t> out = integer(*value);
    if (!out) wrong_type(key, *value, "an integer from 0 to 2^53");
    return out.value_or(fallback);
}

int JsonReader::index(std::string_view key, size_t count, std::string_view what) const {
    const json* value = find(key);
    if (value == nullptr) return -1;
    const std::optional<uint64_t> out = integer(*value);
    if (!out) {
        wrong_type(key, *value, "an integer, 0 or more");
        return -1;
    }
    if (*out >= count || *out > INT32_MAX) {
        fault(key,
              "E-DOC-INDEX",
              "there is no " + std::string(what) + " " + std::to_string(*out) + ": the asset has " +
                  std::to_string(count));
        return -1;
    }
    return static_cast<int>(*out);
}

bool JsonReader::numbers(std::string_view key, std::span<double> out) const {
    const json* value = find(key);
    if (value == nullptr) return false;
    const std::string wanted = "an array of " + std::to_string(out.size()) + " numbers";
    if (!value->is_array() || value->size() != out.size()) {
        wrong_type(key, *value, wanted.c_str());
        return false;
    }
    for (const json& element : *value) {
        if (!element.is_number()) {
            wrong_type(key, element, wanted.c_str());
            return false;
        }
    }
    for (size_t i = 0; i < out.size(); ++i)
        out[i] = (*value)[i].get<double>();
    return true;
}

std::vector<int> JsonReader::indices(std::string_view key,
                                     size_t count,
                                     std::string_view what) const {
    std::vector<int> out;
    const json* value = find(key);
    if (value == nullptr) return out;
    if (!value->is_array()) {
        wrong_type(key, *value, "an array of integers");
        return out;
    }
    out.reserve(value->size());
    for (const json& element : *value) {
        const std::optional<uint64_t> index = integer(element);
        if (!index || *index >= count || *index > INT32_MAX) {
            const std::string name(what);
            fault(key,
                  "E-DOC-INDEX",
                  "element " + std::to_string(out.size()) + " is " + shown_value(element) +
                      "; it must be the number of a " + name + ", and the asset has " +
                      std::to_string(count));
            return {};
        }
        out.push_back(static_cast<int>(*index));
    }
    return out;
}

std::vector<std::vector<int>> JsonReader::index_lists(std::string_view key,
                                                      size_t count,
                                                      std::string_view what) const {
    std::vector<std::vector<int>> out;
    const size_t lists = this->count(key);
    for (size_t i = 0; i < lists && !failed(); ++i) {
        const std::string number = std::to_string(i);
        const json wrapped = {{number, (*find(key))[i]}};
        const JsonReader list(wrapped, pointer_ + pointer_part(key), *fault_);
        out.push_back(list.indices(number, count, what));
    }
    return out;
}

std::vector<std::string> JsonReader::texts(std::string_view key) const {
    std::vector<std::string> out;
    const json* value = find(key);
    if (value == nullptr) return out;
    if (!value->is_array()) wrong_type(key, *value, "an array of strings");
    for (const json& element : *value) {
        if (!value->is_array() || !element.is_string()) {
            wrong_type(key, element, "an array of strings");
            return {};
        }
        out.push_back(element.get<std::string>());
    }
    return out;
}

JsonReader JsonReader::child(std::string_view key) const {
    const json* value = find(key);
    return JsonReader(
        value == nullptr ? empty_object() : *value, pointer_ + pointer_part(key), *fault_);
}

JsonReader JsonReader::extension(std::string_view name) const {
    return child("extensions").child(name);
}

bool JsonReader::has_extension(std::string_view name) const {
    return has("extensions") && child("extensions").has(name);
}

size_t JsonReader::count(std::string_view key) const {
    const json* value = find(key);
    if (value == nullptr) return 0;
    if (value->is_array()) return value->size();
    wrong_type(key, *value, "an array");
    return 0;
}

void JsonReader::each(std::string_view key,
                      const std::function<void(const JsonReader&, size_t)>& body) const {
    const size_t total = count(key);
    const std::string prefix = pointer_ + pointer_part(key) + "/";
    const json* value = find(key);
    for (size_t i = 0; i < total && !failed(); ++i) {
        body(JsonReader((*value)[i], prefix + std::to_string(i), *fault_), i);
    }
}

void JsonReader::each_key(const std::function<void(const std::string&)>& body) const {
    for (const auto& item : object_->items())
        body(item.key());
}

}  // namespace obscura
