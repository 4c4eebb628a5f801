// gltf/parse/document_reading.h - helpers that the readers of a document share.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/parse/document.h"
#include "gltf/parse/number_entry.h"
#include "gltf/parse/value_reader.h"

namespace obscura::gltf {

/// The model, which gltf/parse/preflight.h has checked, and the document that is made of it. Faults
/// go to `fault`; readers go on without branching.
struct DocumentReading {
    const tinygltf::Model& model;  ///< its nodes come in parts
    Document& document;
    Log& log;
    JsonFault& fault;
    std::vector<std::string> clamped = {};     ///< places of numbers outside their range
    std::vector<std::string> misaligned = {};  ///< places of accessors
    std::vector<std::string> empty = {};       ///< places of accessors without elements
    std::vector<std::pair<std::string, uint64_t>> far_uv_sets = {};  ///< by place of the texture
    nlohmann::json& nodes;  ///< what is left of the tree, for read_node_parts
    size_t node_count;

    bool failed() const { return fault.error.has_value(); }
    /// The asset as a whole, for its extensions.
    ModelElement root() const { return {model.extensions, "", fault}; }
};

/// Calls `body(element, place, index)` for each element of an array of the model until a fault.
///
/// In      first: the number of the first element in the asset
template <typename Elements, typename Body>
void each_element(const DocumentReading& reading,
                  const char* array,
                  const Elements& elements,
                  const Body& body,
                  size_t first = 0) {
    const std::string prefix = "/" + std::string(array) + "/";
    for (size_t i = 0; i < elements.size() && !reading.failed(); ++i) {
        const ModelElement place(
            elements[i].extensions, prefix + std::to_string(first + i), reading.fault);
        body(elements[i], place, first + i);
    }
}

/// A name of the file, else "mesh 3".
std::string name_or(const std::string& name, const char* what, size_t index);

/// Brings numbers into the limits; leaving them is noted in `clamped`.
void clamp_numbers(DocumentReading& reading,
                   const std::string& pointer,
                   std::span<double> values,
                   const NumberLimits& limits);

/// The same for a member, a number or an array of more than one.
///
/// In      place: in the object, such as "scale" or "normalTexture/scale"; out: the fallback
void clamped_numbers(DocumentReading& reading,
                     const ValueReader& object,
                     std::string_view place,
                     std::span<double> out,
                     const NumberLimits& limits);

}  // namespace obscura::gltf
