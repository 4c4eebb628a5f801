// session/segmentation.cpp - masks for data sets: the node of every pixel, and a list of the nodes.
// SPDX-License-Identifier: Apache-2.0
#include "session/segmentation.h"

#include "base/atomic_file.h"
#include "base/json/json.h"
#include "film/cryptomatte_names.h"
#include "image/write.h"
#include "scene/node_primitives.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <span>

namespace obscura {

namespace {

constexpr size_t largest_id = 65535;

/// What is seen of one id, in pixels of the whole image.
struct Visible {
    int left = 0, top = 0, right = 0, bottom = 0;  ///< inclusive
    size_t pixels = 0;
    std::set<int32_t> materials = {};  ///< glTF's indices; -1: the default one

    void add(int x, int y) {
        left = pixels == 0 ? x : std::min(left, x);
        right = pixels == 0 ? x : std::max(right, x);
        top = pixels == 0 ? y : std::min(top, y);
        bottom = y;  // rows come from the top
        ++pixels;
    }
};

using VisibleById = std::map<int32_t, Visible>;

int32_t id_at(const OutputImage& ids, size_t pixel) {
    return static_cast<int32_t>(std::lround(ids.pixels[pixel] * float{largest_id}));
}

VisibleById find_visible(const OutputImage& ids) {
    VisibleById out;
    for (int y = 0; y < ids.height; ++y) {
        for (int x = 0; x < ids.width; ++x) {
            const int32_t id = id_at(
                ids,
                static_cast<size_t>(y) * static_cast<size_t>(ids.width) + static_cast<size_t>(x));
            if (id > 0) out[id].add(x, y);
        }
    }
    return out;
}

/// Notes the materials of the primitives that visible nodes consist of.
void find_materials(const Scene& scene, VisibleById& visible) {
    const auto note = [&](int32_t node, int32_t /*instance*/, const Primitive& primitive) {
        const auto found = visible.find(node + 1);
        if (found == visible.end()) return;
        found->second.materials.insert(
            scene.material_numbers[static_cast<size_t>(primitive.material)]);
    };
    for_each_node_primitive(scene, note);
}

std::string document_of(const OutputImage& ids, const Scene& scene) {
    VisibleById visible = find_visible(ids);
    find_materials(scene, visible);
    const CryptomatteTables names = cryptomatte_tables(scene);
    Json segments = Json::array();
    for (const auto& [id, seen] : visible) {
        Json materials = Json::array();
        for (const int32_t number : seen.materials)
            materials.push_back(names.materials[static_cast<size_t>(number) + 1]);
        segments.push_back({{"id", id},
                            {"node", names.objects[static_cast<size_t>(id)]},
                            {"mesh", mesh_name(scene.info, static_cast<size_t>(id) - 1)},
                            {"materials", std::move(materials)},
                            {"box",
                             {{"x", seen.left},
                              {"y", seen.top},
                              {"width", seen.right - seen.left + 1},
                              {"height", seen.bottom - seen.top + 1}}},
                            {"pixels", seen.pixels}});
    }
    return json_document({{"width", ids.width},
                          {"height", ids.height},
                          {"asset", scene.info.file_name},
                          {"segments", std::move(segments)}});
}

}  // namespace

Segmentation segmentation_of(const Film& film, const Scene& scene) {
    const UnsetArray<float>& numbers = film.layers.back().pixels;
    OutputImage part{film.width, film.height, {"Y"}, {}, film.part_of};
    part.pixels.resize(numbers.size());
    std::transform(numbers.begin(), numbers.end(), part.pixels.begin(), [](float number) {
        return number / float{largest_id};
    });
    OutputImage ids = whole_image(part);
    std::string document = document_of(ids, scene);
    return {std::move(ids), std::move(document)};
}

Result<void> check_segmentation(const Scene& scene) {
    const size_t nodes = scene.info.node_names.size();
    if (nodes <= largest_id) return {};
    return fail(ExitCode::unsupported,
                "E-SEG-IDS",
                scene.info.file_name,
                "the asset has " + std::to_string(nodes) +
                    " nodes, and ids of 16 bits are for 65535 at most; the layers id_node and "
                    "crypto_object have no such limit");
}

std::array<std::filesystem::path, 2> segmentation_files(const std::filesystem::path& png) {
    std::filesystem::path json = png;
    return {png, json.replace_extension(".json")};
}

Result<void> write_segmentation(const std::filesystem::path& png,
                                const Segmentation& segmentation,
                                const ImageMetadata& metadata) {
    const auto [image_file, list_file] = segmentation_files(png);
    ImageMetadata data = metadata;
    data.is_color = false;
    DisplayEncoding encoding;
    encoding.bits = 16;
    const auto bytes = std::as_bytes(std::span(segmentation.document));
    if (auto written = write_file_atomically(list_file, bytes); !written) return written;
    const auto written = write_image_file(image_file, segmentation.ids, data, {}, encoding);
    if (!written) return fail(written.error());
    return {};
}

}  // namespace obscura
