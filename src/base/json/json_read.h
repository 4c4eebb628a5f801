// base/json/json_read.h - typed and checked access to nlohmann-json's values.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/json/object_reader.h"

#include <nlohmann/json.hpp>

namespace obscura {

/// nlohmann-json's tree, for ObjectReader.
struct JsonTree {
    using Value = nlohmann::json;
    using Object = nlohmann::json::object_t;

    static JsonKind kind(const Value& value);
    static bool boolean(const Value& value) { return value.get<bool>(); }
    static double number(const Value& value) { return value.get<double>(); }
    /// In [0, 2^53].
    static std::optional<uint64_t> integer(const Value& value);
    static std::string number_text(const Value& value) { return value.dump(); }
    static std::string_view text(const Value& value) { return value.get_ref<const std::string&>(); }
    static const nlohmann::json::array_t& array(const Value& value) {
        return value.get_ref<const nlohmann::json::array_t&>();
    }
    static const Object& object(const Value& value) { return value.get_ref<const Object&>(); }
    static const Value* find(const Object& object, std::string_view key);
};

extern template class ObjectReader<JsonTree>;
using JsonReader = ObjectReader<JsonTree>;

}  // namespace obscura
