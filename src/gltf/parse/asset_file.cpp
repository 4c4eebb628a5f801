// gltf/parse/asset_file.cpp - opens a .gltf or .glb file and reads its JSON.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/asset_file.h"

#include "base/json/json_text.h"
#include "base/memory_budget.h"
#include "gltf/parse/glb.h"

#include <algorithm>

namespace obscura::gltf {

namespace {

constexpr uint64_t largest_asset_file = UINT32_MAX;  // what a GLB header can count

/// Out     charge: what the bytes take
Result<Bytes> read_asset_file(const std::filesystem::path& file, MemoryCharge& charge) {
    const auto take = [&](uint64_t bytes) -> Result<void> {
        Result<MemoryCharge> taken =
            charge_memory(MemoryUse::scene_text, file.filename().string(), bytes);
        if (!taken) return fail(std::move(taken.error()));
        charge = std::move(*taken);
        return {};
    };
    FileBytes read = read_file_bytes(file, {largest_asset_file, UINT64_MAX, take});
    if (read.fault == FileFault::none) return std::move(read.bytes);
    if (read.refusal) return fail(std::move(*read.refusal));
    if (read.fault == FileFault::too_large) {
        return fail(ExitCode::bad_data, "E-GLB-SIZE", file.string(), "the file has " + read.reason);
    }
    return fail(ExitCode::missing_scene,
                "E-SCENE-MISSING",
                file.string(),
                "the scene cannot be read: " + read.reason + "; accepted are .gltf and .glb files");
}

/// About what JSON text takes as a tree, with the strings that are copied from it. A value is 16
/// bytes and grows in an array by halves; a member is a node of a map with its name.
uint64_t tree_bytes(std::string_view text) {
    constexpr uint64_t bytes_per_value = 32;
    constexpr uint64_t bytes_per_member = 112;
    const auto count = [&](char c) {
        return static_cast<uint64_t>(std::count(text.begin(), text.end(), c));
    };
    return 2 * text.size() + bytes_per_value * (count(',') + count('[') + count('{')) +
           bytes_per_member * count(':');
}

}  // namespace

Result<OpenedAsset> open_asset(const std::filesystem::path& path,
                               Problems& problems,
                               Log& log,
                               const MaterialReading& materials) {
    const std::string where = path.string();
    OpenedAsset asset;
    Result<Bytes> bytes = read_asset_file(path, asset.file_charge);
    if (!bytes) return fail(std::move(bytes.error()));
    asset.file = std::move(*bytes);
    const std::span<const std::byte> all = asset.file;
    const std::string_view foreign = guess_foreign_format(all);
    if (all.empty() || !foreign.empty()) {
        const std::string what = all.empty() ? "is empty" : "looks like " + std::string(foreign);
        return fail(ExitCode::bad_data,
                    "E-GLB-FORMAT",
                    where,
                    "the file " + what + "; accepted are glTF 2.0 as JSON text or GLB");
    }
    std::string_view text(reinterpret_cast<const char*>(all.data()), all.size());
    if (is_glb(all)) {
        const Result<GlbChunks> chunks = split_glb(all, where, log);
        if (!chunks) return fail(chunks.error());
        text = chunks->json;
        asset.glb_binary = chunks->binary;
    }
    Result<MemoryCharge> charge =
        charge_memory(MemoryUse::scene_text, path.filename().string(), tree_bytes(text));
    if (!charge) return fail(std::move(charge.error()));
    asset.text_charge = std::move(*charge);
    Result<nlohmann::json> tree = parse_json_text(text, where, log);
    if (!tree) return fail(std::move(tree.error()));
    if (!is_glb(all)) {
        asset.file = Bytes();
        asset.file_charge = {};
    }
    Result<Document> document = read_document(std::move(*tree), where, problems, log, materials);
    if (!document) return fail(std::move(document.error()));
    asset.document = std::move(*document);
    return asset;
}

}  // namespace obscura::gltf
