// tests/gltf/values.h - JSON as tinygltf's values, for readers of extensions.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/parse/model.h"
#include "gltf/parse/value_reader.h"

#include <nlohmann/json.hpp>

namespace obscura::gltf::test {

/// An extension's object as a reader of the asset would see it.
inline tinygltf::Value value_of(nlohmann::json object) {
    for (nlohmann::json& member : object)
        mark_for_values(member);
    nlohmann::json tree;
    tree["extensions"]["X"] = std::move(object);
    return read_model(tree, "").value().extensions.at("X");
}

}  // namespace obscura::gltf::test
