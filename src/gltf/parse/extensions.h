// gltf/parse/extensions.h - the table of supported extensions, and warnings about others.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/json/json_read.h"
#include "gltf/parse/document.h"

#include <span>
#include <string_view>

namespace obscura::gltf {

/// To support one more: set `supported` in the table in extensions.cpp, name it with its object in
/// tree_rules.cpp, for what is not named there is taken out, read it where the object is read, and
/// change its line in docs/gltf.md, which a test compares. An extension that is not in
/// the table is ignored like any other.
struct ExtensionEntry {
    std::string_view name;
    bool supported;
    std::string_view without;             ///< what an image lacks when it is not supported
    std::string_view note = {};           ///< of a supported one: how, or why it changes nothing
    Verdict verdict = Verdict::honoured;  ///< of a supported one
};

std::span<const ExtensionEntry> extension_table();

const ExtensionEntry* find_extension(std::string_view name);  ///< nullptr: it is not in the table

/// The extension names anywhere inside an object but in `extras`, sorted, each once.
std::vector<std::string> extension_names(const nlohmann::json& object);

/// Fills document.extensions from extensionsUsed, extensionsRequired and the objects themselves,
/// and warns once about each that is ignored, naming the materials and other objects that use it.
///
/// Errors  69 E-EXT-REQUIRED, listing all that are missing; not where `lenient`
Result<void> read_extensions(
    const JsonReader& root, const nlohmann::json& tree, bool lenient, Document& document, Log& log);

}  // namespace obscura::gltf
