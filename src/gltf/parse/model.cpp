// gltf/parse/model.cpp - makes tinygltf's model from a checked JSON tree.
// SPDX-License-Identifier: Apache-2.0
#include <fstream>
#include <nlohmann/json.hpp>

namespace {

/// What tinygltf is to read next on this thread.
thread_local nlohmann::json* next_tree = nullptr;

void take_tree(nlohmann::json& tree) {
    if (next_tree != nullptr) tree = std::move(*next_tree);
    next_tree = nullptr;
}

}  // namespace

// tinygltf hands its text to a function of this name. These overloads, which fit its call better
// than its own (2.7 finds the first one, later versions the second one), give it the tree that the
// checks have parsed already, so that no text is parsed twice.
namespace tinygltf {
// NOLINTNEXTLINE(readability-identifier-naming): its name
inline void JsonParse(nlohmann::json& tree, const char* /*text*/, unsigned int, bool) {
    take_tree(tree);
}
namespace detail {
// NOLINTNEXTLINE(readability-identifier-naming): its name
inline void JsonParse(nlohmann::json& tree, const char* /*text*/, unsigned int, bool) {
    take_tree(tree);
}
}  // namespace detail
}  // namespace tinygltf

#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_FS
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_INCLUDE_JSON
#include "gltf/parse/model.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace obscura::gltf {

namespace {

using nlohmann::json;

/// Leaves images as they are: gltf/materials/textures.h decodes them.
bool keep_image(tinygltf::Image*,
                const int,
                std::string*,
                std::string*,
                int,
                int,
                const unsigned char*,
                int,
                void*) {
    return true;
}

Result<tinygltf::Model> read_part(json&& tree, const std::string& file) {
    tinygltf::TinyGLTF reader;
    reader.SetImageLoader(keep_image, nullptr);
    tinygltf::Model model;
    std::string why;
    const auto load = [&](const std::string& text) {
        std::string warnings;
        why.clear();
        return reader.LoadASCIIFromString(&model,
                                          &why,
                                          &warnings,
                                          text.data(),
                                          static_cast<unsigned int>(text.size()),
                                          "",
                                          tinygltf::NO_REQUIRE);
    };
    try {
        next_tree = &tree;
        bool done = load("null");
        // A version that does not ask for the tree gets the text.
        if (std::exchange(next_tree, nullptr) != nullptr) done = load(tree.dump());
        if (done) return model;
    } catch (const json::exception& problem) {
        why = problem.what();
    }
    next_tree = nullptr;
    return fail(ExitCode::internal, "E-INTERNAL", file, "tinygltf: " + why);
}

json& array_of(json& tree, const char* key) {
    json& array = tree[key];
    if (!array.is_array()) array = json::array();
    return array;
}

}  // namespace

int placeholder_view(const json& tree) {
    const auto views = tree.find("bufferViews");
    return views == tree.end() ? 0 : static_cast<int>(views->size());
}

Result<tinygltf::Model> read_model(json& tree, const std::string& file) {
    json nodes = std::move(array_of(tree, "nodes"));
    tree.erase("nodes");
    const int added_view = placeholder_view(tree);
    json& buffers = array_of(tree, "buffers");
    array_of(tree, "bufferViews").push_back({{"buffer", buffers.size()}, {"byteLength", 1U}});
    buffers.push_back({{"byteLength", 1U}, {"uri", placeholder_uri}});

    Result<tinygltf::Model> model = read_part(std::move(tree), file);
    if (!model) return model;
    model->buffers.pop_back();
    model->bufferViews.pop_back();
    for (tinygltf::Accessor& accessor : model->accessors) {
        if (accessor.bufferView == added_view) accessor.bufferView = -1;
    }
    tree = json::object();
    tree["nodes"] = std::move(nodes);
    return model;
}

Result<void> read_node_parts(json&& tree, const std::string& file, const VisitNodes& visit) {
    constexpr size_t part_size = 4096;
    auto& nodes = array_of(tree, "nodes").get_ref<json::array_t&>();
    for (size_t first = 0; first < nodes.size(); first += part_size) {
        const auto begin = nodes.begin() + static_cast<std::ptrdiff_t>(first);
        const size_t count = std::min(part_size, nodes.size() - first);
        const auto end = begin + static_cast<std::ptrdiff_t>(count);
        json part = json::object();
        part["nodes"] = json::array_t(std::make_move_iterator(begin), std::make_move_iterator(end));
        const Result<tinygltf::Model> read = read_part(std::move(part), file);
        if (!read) return fail(read.error());
        if (!visit(read->nodes, first)) break;
    }
    return {};
}

}  // namespace obscura::gltf
