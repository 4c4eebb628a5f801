// tests/gltf/gltf_files.h - builds small glTF assets, sound and broken ones, and loads them.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/load.h"

#include <gtest/gtest.h>

#include "support/temp_folder.h"
#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace obscura::gltf::test {

using nlohmann::json;

inline std::string base64(std::string_view bytes) {
    constexpr std::string_view alphabet =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        unsigned group = 0;
        for (size_t j = 0; j < 3; ++j) {
            const auto byte = i + j < bytes.size() ? static_cast<unsigned char>(bytes[i + j]) : 0U;
            group = group << 8 | byte;
        }
        for (size_t j = 0; j < 4; ++j) {
            out += i + j > bytes.size() ? '=' : alphabet[group >> (18 - 6 * j) & 63U];
        }
    }
    return out;
}

template <typename T>
std::string raw(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

inline std::string u32(uint32_t value) {
    return raw(std::vector<uint32_t>{value});
}

inline std::string glb_chunk(std::string_view type, std::string data, char pad) {
    while (data.size() % 4 != 0)
        data += pad;
    return u32(static_cast<uint32_t>(data.size())) + std::string(type) + data;
}

/// Header and chunks, with the right length.
inline std::string glb_of(const std::string& chunks, uint32_t version = 2) {
    return "glTF" + u32(version) + u32(static_cast<uint32_t>(12 + chunks.size())) + chunks;
}

inline std::string glb_of(const std::string& text, const std::string& binary) {
    return glb_of(glb_chunk("JSON", text, ' ') +
                  glb_chunk(std::string_view("BIN\0", 4), binary, 0));
}

/// An asset that grows accessor by accessor, all in one buffer.
struct AssetBuilder {
    json tree = {{"asset", {{"version", "2.0"}}}};
    std::string bytes;

    int add_view(const std::string& data) {
        while (bytes.size() % 4 != 0)
            bytes += '\0';
        tree["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", data.size()}});
        bytes += data;
        return static_cast<int>(tree["bufferViews"].size()) - 1;
    }

    template <typename T>
    int add_accessor(const char* type, int component, const std::vector<T>& values) {
        static const json widths = {
            {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};
        const size_t width = widths[type].get<size_t>();
        json accessor = {{"bufferView", add_view(raw(values))},
                         {"componentType", component},
                         {"count", values.size() / width},
                         {"type", type}};
        if (component == 5126 && width == 3) add_bounds(accessor, values);
        tree["accessors"].push_back(accessor);
        return static_cast<int>(tree["accessors"].size()) - 1;
    }

    template <typename T>
    static void add_bounds(json& accessor, const std::vector<T>& values) {
        for (size_t axis = 0; axis < 3; ++axis) {
            T low = values[axis];
            T high = values[axis];
            for (size_t i = axis; i < values.size(); i += 3) {
                low = std::min(low, values[i]);
                high = std::max(high, values[i]);
            }
            accessor["min"].push_back(low);
            accessor["max"].push_back(high);
        }
    }

    /// Adds a mesh of one primitive; returns its number.
    int add_mesh(const json& primitive) {
        tree["meshes"].push_back({{"primitives", json::array({primitive})}});
        return static_cast<int>(tree["meshes"].size()) - 1;
    }

    /// Adds a node to the one scene; returns its number.
    int add_root(const json& node) {
        tree["nodes"].push_back(node);
        const int number = static_cast<int>(tree["nodes"].size()) - 1;
        tree["scenes"][0]["nodes"].push_back(number);
        return number;
    }

    /// The JSON with the buffer inside.
    json finished() const {
        json out = tree;
        if (bytes.empty()) return out;
        out["buffers"][0] = {{"byteLength", bytes.size()},
                             {"uri", "data:application/octet-stream;base64," + base64(bytes)}};
        return out;
    }

    std::string glb() const {
        json out = tree;
        out["buffers"][0]["byteLength"] = bytes.size();
        return glb_of(out.dump(), bytes);
    }
};

/// One triangle in the XY plane: accessor 0 POSITION, 1 NORMAL, 2 TEXCOORD_0, 3 indices.
inline AssetBuilder triangle_builder() {
    AssetBuilder builder;
    builder.add_accessor("VEC3", 5126, std::vector<float>{0, 0, 0, 2, 0, 0, 0, 1, 0});
    builder.add_accessor("VEC3", 5126, std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1});
    builder.add_accessor("VEC2", 5126, std::vector<float>{0, 1, 1, 1, 0, 0});
    builder.add_accessor("SCALAR", 5123, std::vector<uint16_t>{0, 1, 2});
    builder.add_mesh(
        {{"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"TEXCOORD_0", 2}}}, {"indices", 3}});
    builder.add_root({{"mesh", 0}});
    return builder;
}

inline json triangle_asset() {
    return triangle_builder().finished();
}

/// What loading gave, with every warning in one text.
struct Loaded {
    Result<Scene> scene;
    std::string warnings;

    int code() const { return scene ? 0 : static_cast<int>(scene.error().code); }
    std::string id() const { return scene ? "" : scene.error().id; }
    std::string text() const {
        return scene ? "" : scene.error().where + ": " + scene.error().message;
    }
    bool warns(std::string_view words) const { return warnings.find(words) != std::string::npos; }
};

inline Loaded load_file(const std::filesystem::path& file, const LoadOptions& options = {}) {
    Log log(Verbosity::quiet);
    Loaded out{load_gltf(file, options, log), {}};
    for (const std::string& warning : log.warnings())
        out.warnings += warning + "\n";
    return out;
}

/// Writes the bytes to a folder of their own and loads them.
inline Loaded load_bytes(const std::string& bytes,
                         const std::string& name = "scene.gltf",
                         const LoadOptions& options = {}) {
    const TempFolder folder;
    return load_file(folder.write(name, bytes), options);
}

inline Loaded load_tree(const json& tree, const LoadOptions& options = {}) {
    return load_bytes(tree.dump(), "scene.gltf", options);
}

/// The absolute vertex's three floats.
inline std::vector<float> position_of(const Scene& scene, uint32_t vertex) {
    const auto begin = scene.positions.begin() + 3 * static_cast<std::ptrdiff_t>(vertex);
    return {begin, begin + 3};
}

/// `width` floats of a vertex attribute.
inline std::vector<float> attribute_of(const Scene& scene,
                                       int32_t base,
                                       uint32_t vertex,
                                       int width) {
    const auto begin =
        scene.attributes.begin() + base + static_cast<std::ptrdiff_t>(vertex) * width;
    return {begin, begin + width};
}

}  // namespace obscura::gltf::test
