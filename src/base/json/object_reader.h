// base/json/object_reader.h - typed and checked access to JSON objects, for any JSON library.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"

#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace obscura {

/// The first fault of a whole document and its location.
struct JsonFault {
    std::string file;  ///< as the user named it
    std::optional<Error> error;
};

enum class JsonKind { null, boolean, number, text, array, object };

/// A key as a part of a JSON pointer: with "/" before it, ~ and / written ~0 and ~1 (RFC 6901).
std::string json_pointer_part(std::string_view key);

/// One JSON object with its location. Getters return the fallback when the member is absent. When
/// it is wrong they also record the fault, unless there is one already: readers need no branches,
/// and the caller checks for a fault once.
///
/// `Tree` adapts a JSON library: `Value` and `Object` (a map from names to values), kind, boolean,
/// number, text, array, object, and number_text for messages.
template <typename Tree>
class ObjectReader {
public:
    using Value = typename Tree::Value;
    using Object = typename Tree::Object;

    ObjectReader(const Value& value, std::string pointer, JsonFault& fault);
    /// A reader of an object's members.
    static ObjectReader of(const Object& object, std::string pointer, JsonFault& fault) {
        return ObjectReader(&object, std::move(pointer), fault);
    }

    bool has(std::string_view key) const { return find(key) != nullptr; }
    bool failed() const { return fault_->error.has_value(); }

    double number(std::string_view key, double fallback) const;
    bool boolean(std::string_view key, bool fallback) const;
    std::string text(std::string_view key, std::string fallback = {}) const;
    /// An integer in [0, 2^53]; written as 3, 3.0 or 3e0.
    uint64_t size(std::string_view key, uint64_t fallback) const;
    /// An integer below `count`; -1 when absent. `what` names the array for the message.
    int index(std::string_view key, size_t count, std::string_view what) const;
    /// Exactly out.size() numbers; false, with `out` unchanged, when absent or wrong.
    bool numbers(std::string_view key, std::span<double> out) const;
    std::vector<int> indices(std::string_view key, size_t count, std::string_view what) const;
    /// An array of such arrays.
    std::vector<std::vector<int>> index_lists(std::string_view key,
                                              size_t count,
                                              std::string_view what) const;
    std::vector<std::string> texts(std::string_view key) const;

    /// The member object; absent: an empty one.
    ObjectReader child(std::string_view key) const;
    /// extensions/<name>; absent: an empty one.
    ObjectReader extension(std::string_view name) const { return child("extensions").child(name); }
    bool has_extension(std::string_view name) const {
        return has("extensions") && child("extensions").has(name);
    }
    /// Number of elements of an array; 0 when absent.
    size_t count(std::string_view key) const;
    /// Calls `body(element, index)` for each object in an array.
    void each(std::string_view key,
              const std::function<void(const ObjectReader&, size_t)>& body) const;
    /// Calls `body(name)` for each member.
    void each_key(const std::function<void(const std::string&)>& body) const;

    /// Records a fault (65) of member `key`; of the object itself when `key` is empty.
    void fault(std::string_view key, const char* id, std::string message) const;
    /// Records a fault when the member is absent.
    void require(std::string_view key) const;

    const std::string& pointer() const { return pointer_; }

private:
    ObjectReader(const Object* object, std::string pointer, JsonFault& fault)
        : object_(object), pointer_(std::move(pointer)), fault_(&fault) {}

    static const Object& empty_object();
    static std::string shown(const Value& value);
    const Value* find(std::string_view key) const;
    void wrong_type(std::string_view key, const Value& value, const char* wanted) const;
    static bool is(const Value& value, JsonKind kind) { return Tree::kind(value) == kind; }

    const Object* object_;
    std::string pointer_;
    JsonFault* fault_;
};

/// The number as an integer; nothing unless it is one in [0, 2^53].
inline std::optional<uint64_t> json_integer(double number) {
    constexpr double largest = 9007199254740992.0;  // 2^53
    if (!(number >= 0 && number <= largest) || number != std::floor(number)) return std::nullopt;
    return static_cast<uint64_t>(number);
}

template <typename Tree>
const typename Tree::Object& ObjectReader<Tree>::empty_object() {
    static const Object object;
    return object;
}

template <typename Tree>
std::string ObjectReader<Tree>::shown(const Value& value) {
    switch (Tree::kind(value)) {
        case JsonKind::array:
            return "an array of " + std::to_string(Tree::array(value).size());
        case JsonKind::object:
            return "an object";
        case JsonKind::null:
            return "null";
        case JsonKind::text:
            return "a string";
        case JsonKind::boolean:
            return Tree::boolean(value) ? "true" : "false";
        case JsonKind::number:
            break;
    }
    return Tree::number_text(value);
}

template <typename Tree>
ObjectReader<Tree>::ObjectReader(const Value& value, std::string pointer, JsonFault& fault)
    : ObjectReader(is(value, JsonKind::object) ? &Tree::object(value) : &empty_object(),
                   std::move(pointer),
                   fault) {
    if (!is(value, JsonKind::object)) wrong_type("", value, "an object");
}

template <typename Tree>
const typename Tree::Value* ObjectReader<Tree>::find(std::string_view key) const {
    return Tree::find(*object_, key);
}

template <typename Tree>
void ObjectReader<Tree>::fault(std::string_view key, const char* id, std::string message) const {
    if (fault_->error) return;
    const std::string place = key.empty() ? pointer_ : pointer_ + json_pointer_part(key);
    fault_->error = Error{ExitCode::bad_data, id, fault_->file + "#" + place, std::move(message)};
}

template <typename Tree>
void ObjectReader<Tree>::wrong_type(std::string_view key,
                                    const Value& value,
                                    const char* wanted) const {
    fault(key, "E-JSON-TYPE", "this is " + shown(value) + "; it must be " + wanted);
}

template <typename Tree>
void ObjectReader<Tree>::require(std::string_view key) const {
    if (!has(key)) {
        fault("", "E-DOC-MISSING", "the member \"" + std::string(key) + "\" is required");
    }
}

template <typename Tree>
double ObjectReader<Tree>::number(std::string_view key, double fallback) const {
    const Value* value = find(key);
    if (value == nullptr) return fallback;
    if (is(*value, JsonKind::number)) return Tree::number(*value);
    wrong_type(key, *value, "a number");
    return fallback;
}

template <typename Tree>
bool ObjectReader<Tree>::boolean(std::string_view key, bool fallback) const {
    const Value* value = find(key);
    if (value == nullptr) return fallback;
    if (is(*value, JsonKind::boolean)) return Tree::boolean(*value);
    wrong_type(key, *value, "true or false");
    return fallback;
}

template <typename Tree>
std::string ObjectReader<Tree>::text(std::string_view key, std::string fallback) const {
    const Value* value = find(key);
    if (value == nullptr) return fallback;
    if (is(*value, JsonKind::text)) return std::string(Tree::text(*value));
    wrong_type(key, *value, "a string");
    return fallback;
}

template <typename Tree>
uint64_t ObjectReader<Tree>::size(std::string_view key, uint64_t fallback) const {
    const Value* value = find(key);
    if (value == nullptr) return fallback;
    const std::optional<uint64_t> out = Tree::integer(*value);
    if (!out) wrong_type(key, *value, "an integer from 0 to 2^53");
    return out.value_or(fallback);
}

template <typename Tree>
int ObjectReader<Tree>::index(std::string_view key, size_t count, std::string_view what) const {
    const Value* value = find(key);
    if (value == nullptr) return -1;
    const std::optional<uint64_t> out = Tree::integer(*value);
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

template <typename Tree>
bool ObjectReader<Tree>::numbers(std::string_view key, std::span<double> out) const {
    const Value* value = find(key);
    if (value == nullptr) return false;
    const std::string wanted = "an array of " + std::to_string(out.size()) + " numbers";
    if (!is(*value, JsonKind::array) || Tree::array(*value).size() != out.size()) {
        wrong_type(key, *value, wanted.c_str());
        return false;
    }
    for (const Value& element : Tree::array(*value)) {
        if (!is(element, JsonKind::number)) {
            wrong_type(key, element, wanted.c_str());
            return false;
        }
    }
    for (size_t i = 0; i < out.size(); ++i)
        out[i] = Tree::number(Tree::array(*value)[i]);
    return true;
}

template <typename Tree>
std::vector<int> ObjectReader<Tree>::indices(std::string_view key,
                                             size_t count,
                                             std::string_view what) const {
    std::vector<int> out;
    const Value* value = find(key);
    if (value == nullptr) return out;
    if (!is(*value, JsonKind::array)) {
        wrong_type(key, *value, "an array of integers");
        return out;
    }
    out.reserve(Tree::array(*value).size());
    for (const Value& element : Tree::array(*value)) {
        const std::optional<uint64_t> index = Tree::integer(element);
        if (!index || *index >= count || *index > INT32_MAX) {
            const std::string name(what);
            fault(key,
                  "E-DOC-INDEX",
                  "element " + std::to_string(out.size()) + " is " + shown(element) +
                      "; it must be the number of a " + name + ", and the asset has " +
                      std::to_string(count));
            return {};
        }
        out.push_back(static_cast<int>(*index));
    }
    return out;
}

template <typename Tree>
std::vector<std::vector<int>> ObjectReader<Tree>::index_lists(std::string_view key,
                                                              size_t count,
                                                              std::string_view what) const {
    std::vector<std::vector<int>> out;
    const size_t lists = this->count(key);
    for (size_t i = 0; i < lists && !failed(); ++i) {
        const std::string number = std::to_string(i);
        Object wrapped;
        wrapped.emplace(number, Tree::array(*find(key))[i]);
        const ObjectReader list(&wrapped, pointer_ + json_pointer_part(key), *fault_);
        out.push_back(list.indices(number, count, what));
    }
    return out;
}

template <typename Tree>
std::vector<std::string> ObjectReader<Tree>::texts(std::string_view key) const {
    std::vector<std::string> out;
    const Value* value = find(key);
    if (value == nullptr) return out;
    if (!is(*value, JsonKind::array)) {
        wrong_type(key, *value, "an array of strings");
        return out;
    }
    for (const Value& element : Tree::array(*value)) {
        if (!is(element, JsonKind::text)) {
            wrong_type(key, element, "an array of strings");
            return {};
        }
        out.emplace_back(Tree::text(element));
    }
    return out;
}

template <typename Tree>
ObjectReader<Tree> ObjectReader<Tree>::child(std::string_view key) const {
    const Value* value = find(key);
    std::string place = pointer_ + json_pointer_part(key);
    if (value == nullptr) return ObjectReader(&empty_object(), std::move(place), *fault_);
    return ObjectReader(*value, std::move(place), *fault_);
}

template <typename Tree>
size_t ObjectReader<Tree>::count(std::string_view key) const {
    const Value* value = find(key);
    if (value == nullptr) return 0;
    if (is(*value, JsonKind::array)) return Tree::array(*value).size();
    wrong_type(key, *value, "an array");
    return 0;
}

template <typename Tree>
void ObjectReader<Tree>::each(std::string_view key,
                              const std::function<void(const ObjectReader&, size_t)>& body) const {
    const size_t total = count(key);
    const std::string prefix = pointer_ + json_pointer_part(key) + "/";
    const Value* value = find(key);
    for (size_t i = 0; i < total && !failed(); ++i) {
        body(ObjectReader(Tree::array(*value)[i], prefix + std::to_string(i), *fault_), i);
    }
}

template <typename Tree>
void ObjectReader<Tree>::each_key(const std::function<void(const std::string&)>& body) const {
    for (const auto& member : *object_)
        body(member.first);
}

}  // namespace obscura
