// gltf/json_read.h - typed and checked access to JSON objects; the first fault is kept.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace obscura {

/// The first fault of a whole document and where it was.
struct JsonFault {
    std::string file;  ///< as the user named it
    std::optional<Error> error;
};

/// One JSON object with its place. Getters return the fallback when the member is absent; when it
/// is wrong they record the fault (unless there is one already) and return the fallback too, so
/// that readers go on without branching and the caller looks at the fault once.
class JsonReader {
public:
    JsonReader(const nlohmann::json& object, std::string pointer, JsonFault& fault);

    bool has(std::string_view key) const { return find(key) != nullptr; }
    bool failed() const { return fault_->error.has_value(); }

    double number(std::string_view key, double fallback) const;
    bool boolean(std::string_view key, bool fallback) const;
    std::string text(std::string_view key, std::string fallback = {}) const;
    /// An integer in [0, 2^53]; written as 3, 3.0 or 3e0.
    uint64_t size(std::string_view key, uint64_t fallback) const;
    /// An integer below `count`; -1 when absent. `what` names the array for the message.
    int index(std::string_view key, size_t count, std::string_view what) const;
    /// Exactly out.size() numbers; false when absent or wrong, then `out` is as before.
    bool numbers(std::string_view key, std::span<double> out) const;
    std::vector<int> indices(std::string_view key, size_t count, std::string_view what) const;
    /// An array of such arrays.
    std::vector<std::vector<int>> index_lists(std::string_view key,
                                              size_t count,
                                              std::string_view what) const;
    std::vector<std::string> texts(std::string_view key) const;

    /// The member object; absent: an empty one.
    JsonReader child(std::string_view key) const;
    /// extensions/<name>; absent: an empty one.
    JsonReader extension(std::string_view name) const;
    bool has_extension(std::string_view name) const;
    /// Number of elements of an array; 0 when absent.
    size_t count(std::string_view key) const;
    /// Calls `body(element, index)` for each object in an array.
    void each(std::string_view key,
              const std::function<void(const JsonReader&, size_t)>& body) const;
    /// Calls `body(name)` for each member.
    void each_key(const std::function<void(const std::string&)>& body) const;

    /// Records a fault (65) of member `key`; of the object itself when `key` is empty.
    void fault(std::string_view key, const char* id, std::string message) const;
    /// Records a fault when the member is absent.
    void require(std::string_view key) const;

    const std::string& pointer() const { return pointer_; }
    const nlohmann::json& object() const { return *object_; }

private:
    const nlohmann::json* find(std::string_view key) const;
    void wrong_type(std::string_view key, const nlohmann::json& value, const char* wanted) const;
    /// The integer in a JSON number; nothing when it is not one in [0, 2^53].
    static std::optional<uint64_t> integer(const nlohmann::json& value);

    const nlohmann::json* object_;
    std::string pointer_;
    JsonFault* fault_;
};

}  // namespace obscura
