// scene/asset_info.h - facts about the asset for `obscura info` and for image metadata.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace obscura {

/// How far the renderer honours a feature that a file asks for.
enum class Verdict { honoured, approximated, ignored };

struct ExtensionInfo {
    std::string name;
    bool required = false;
    bool supported = false;              ///< false: ignored, with a warning
    std::vector<std::string> materials;  ///< names of the materials that use it, if any
};

/// One feature that a part of the file asks for.
struct ReportEntry {
    std::string place;    ///< "material 3 Glass", "asset"
    std::string feature;  ///< an extension's name or glTF's own word
    Verdict verdict = Verdict::honoured;
    std::string note;  ///< how it is approximated, why it is ignored; may be empty
};

struct ImageInfo {
    std::string name;    ///< its name, URI or "image 3"
    std::string format;  ///< "png", "jpeg", "webp", "ktx2"
    int width = 0;
    int height = 0;
    int bits = 8;  ///< per channel
    bool used_as_color = false;
    bool used_as_data = false;
};

struct NamedCount {
    std::string name;
    size_t count = 0;  ///< triangles of a mesh, instances of a shape
};

struct AnimationInfo {
    std::string name;
    size_t channels = 0;  ///< that can be played
    double end_s = 0;     ///< when the last keyframe comes
};

/// Counts and names from the file, in file order.
struct AssetInfo {
    std::string file_name;  ///< without folder
    std::string version;
    std::string generator;
    std::string copyright;
    std::vector<std::string> scenes;    ///< names; unnamed ones are "scene 0"
    int scene = 0;                      ///< the one that was loaded
    std::vector<std::string> variants;  ///< names from KHR_materials_variants
    std::string variant;                ///< the chosen one; empty: none
    std::string xmp;                    ///< the asset's XMP packet as JSON text; may be empty
    std::vector<NamedCount> meshes;     ///< as in the file, triangles counted once
    std::vector<NamedCount> shapes;     ///< by type, every instance counted
    std::vector<AnimationInfo> animations;
    std::optional<double> time_s;          ///< time of the pose; nothing: the pose as stored
    std::vector<std::string> node_names;   ///< by glTF node index
    std::vector<int32_t> node_parents;     ///< likewise; -1: a root
    std::vector<int32_t> node_meshes;      ///< likewise, in `meshes`; -1: none
    std::vector<std::string> light_names;  ///< beside Scene::lights
    std::vector<int32_t> light_nodes;      ///< likewise: glTF node
    std::string environment;               ///< name of the scene's image-based light; empty: none
    std::vector<ImageInfo> images;
    std::vector<ExtensionInfo> extensions;
    std::vector<ReportEntry> report;  ///< part by part, in file order
    size_t triangles_in_world = 0;    ///< with every instance counted
    size_t points_in_world = 0;       ///< likewise
    size_t line_segments_in_world = 0;
    size_t splats_in_world = 0;
    double parse_seconds = 0;
    double decode_seconds = 0;  ///< images
};

}  // namespace obscura
