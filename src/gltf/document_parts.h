// gltf/document_parts.h - the parts of read_document, one for each group of JSON arrays.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/document.h"
#include "gltf/json_read.h"

namespace obscura {

/// What the parts share. Faults go to the reader's JsonFault; the array lengths that indices are
/// checked against come from `root`.
struct DocumentReading {
    const JsonReader& root;
    Document& document;
    Log& log;
    std::vector<std::string> clamped = {};     ///< places of numbers outside their range
    std::vector<std::string> misaligned = {};  ///< places of accessors
    std::vector<std::string> empty = {};       ///< places of accessors without elements
    std::vector<std::pair<std::string, uint64_t>> far_uv_sets = {};  ///< by place of the texture
};

struct NumberRange {
    double fallback;
    double low;
    double high;
};

/// A number brought into its range; leaving it is noted in `clamped`.
double clamped_number(DocumentReading& reading,
                      const JsonReader& object,
                      std::string_view key,
                      const NumberRange& range);

/// An array of numbers, all in one range; `out` holds the fallback.
void clamped_numbers(DocumentReading& reading,
                     const JsonReader& object,
                     std::string_view key,
                     std::span<double> out,
                     const NumberRange& range);

void read_buffers(DocumentReading& reading);  // document_buffers.cpp
void read_views(DocumentReading& reading);
/// EXT_ and KHR_meshopt_compression of a view whose own numbers are good; document_meshopt.cpp
void read_view_meshopt(DocumentReading& reading, const JsonReader& view, GltfBufferView& out);
void read_accessors(DocumentReading& reading);
void read_images(DocumentReading& reading);  // document_materials.cpp
void read_samplers(DocumentReading& reading);
void read_textures(DocumentReading& reading);
void read_materials(DocumentReading& reading);
void read_meshes(DocumentReading& reading);  // document_meshes.cpp
/// "weights" of a mesh or node, checked against the number of its morph targets;
/// document_meshes.cpp
std::vector<double> read_morph_weights(const JsonReader& object, size_t target_count);
/// KHR_gaussian_splatting of a primitive whose attributes and mode are read; document_splats.cpp
void read_splats(const JsonReader& primitive, GltfPrimitive& out);
/// Where the number of an attribute of splats is kept; nullptr: the name is another one.
int* splat_slot(GltfSplatAttributes& attributes, const std::string& name);
/// "SH_DEGREE_2_COEF_4"
std::string splat_harmonic_name(int degree, int number);
void read_skins(DocumentReading& reading);  // document_animations.cpp
void read_animations(DocumentReading& reading);
void read_nodes(DocumentReading& reading);  // document_nodes.cpp
void read_scenes(DocumentReading& reading);
void read_cameras(DocumentReading& reading);
void read_lights(DocumentReading& reading);
void read_light_profiles(DocumentReading& reading);  // document_lights.cpp
GltfProfileUse read_node_profile(DocumentReading& reading, const JsonReader& node);
void read_environments(DocumentReading& reading);
void read_shapes(DocumentReading& reading);  // document_shapes.cpp
void read_node_shape(DocumentReading& reading, const JsonReader& node, GltfNode& out);

}  // namespace obscura
