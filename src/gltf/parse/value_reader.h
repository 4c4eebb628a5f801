// gltf/parse/value_reader.h - checked reading of extensions from tinygltf's values.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/json/object_reader.h"

#include <tiny_gltf.h>

#include <nlohmann/json_fwd.hpp>

namespace obscura::gltf {

/// tinygltf's values drop null and empty members and wrap integers beyond 32 bits. This encodes
/// such members so that ValueReader reads them as they were.
void mark_for_values(nlohmann::json& tree);

/// tinygltf's values, for ObjectReader; what mark_for_values has marked is understood.
struct ValueTree {
    using Value = tinygltf::Value;
    using Object = tinygltf::Value::Object;

    static JsonKind kind(const Value& value);
    static bool boolean(const Value& value) { return value.Get<bool>(); }
    static double number(const Value& value) { return value.GetNumberAsDouble(); }
    /// In [0, 2^53].
    static std::optional<uint64_t> integer(const Value& value);
    static std::string number_text(const Value& value);
    static std::string_view text(const Value& value);
    static const Value::Array& array(const Value& value);
    static const Object& object(const Value& value);
    static const Value* find(const Object& object, std::string_view key);
};

}  // namespace obscura::gltf

namespace obscura {
extern template class ObjectReader<gltf::ValueTree>;
}  // namespace obscura

namespace obscura::gltf {
using ValueReader = ObjectReader<ValueTree>;

/// An object of the model: its place, for faults, and its extensions.
class ModelElement {
public:
    ModelElement(const tinygltf::ExtensionMap& extensions, std::string pointer, JsonFault& fault)
        : extensions_(&extensions), pointer_(std::move(pointer)), fault_(&fault) {}

    bool has_extension(const std::string& name) const { return extensions_->count(name) != 0; }
    /// Absent: an empty one.
    ValueReader extension(std::string_view name) const {
        return ValueReader::of(*extensions_, pointer_ + "/extensions", *fault_).child(name);
    }
    /// Records a fault (65) of member `key`; of the object itself when `key` is empty.
    void fault(std::string_view key, const char* id, std::string message) const {
        ValueReader::of(*extensions_, pointer_, *fault_).fault(key, id, std::move(message));
    }
    /// An object in this one, for its faults and its extensions.
    ModelElement child(std::string_view key, const tinygltf::ExtensionMap& extensions) const {
        return {extensions, pointer_ + "/" + std::string(key), *fault_};
    }
    bool failed() const { return fault_->error.has_value(); }
    const std::string& pointer() const { return pointer_; }

private:
    const tinygltf::ExtensionMap* extensions_;
    std::string pointer_;
    JsonFault* fault_;
};

}  // namespace obscura::gltf
