// gltf/parse/tree_check.h - checks one object of a JSON tree by its rules.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/json/json_read.h"
#include "gltf/parse/tree_rules.h"

namespace obscura::gltf {

/// Where an object is, without the cost of a text for those that are sound.
struct TreePlace {
    const TreePlace* above = nullptr;
    std::string_view key = {};
    size_t index = 0;  ///< where there is no key: in the array above

    /// As a JSON pointer.
    std::string text() const;
};

/// How many elements each TreeArray has.
using TreeCounts = std::array<size_t, tree_array_names.size()>;

struct TreeCheck {
    const TreeCounts& counts;
    JsonFault& fault;
};

/// Checks an object and the objects in it, and rewrites what tinygltf would read differently from
/// glTF. Extensions that the rules do not name are removed.
///
/// Errors  in the fault: those of JsonReader
void check_object(nlohmann::json& object,
                  const ObjectRules& rules,
                  const TreePlace& place,
                  TreeCheck& check);

}  // namespace obscura::gltf
