// serve/scene_cache.cpp - scenes that clients send with each request, read and built once.
// SPDX-License-Identifier: Apache-2.0
#include "serve/scene_cache.h"

#include "base/atomic_file.h"

#include <algorithm>
#include <string_view>

namespace obscura::serve {

namespace {

namespace fs = std::filesystem;

bool is_glb(std::span<const std::byte> bytes) {
    constexpr std::string_view magic = "glTF";
    return bytes.size() >= magic.size() &&
           std::equal(magic.begin(), magic.end(), bytes.begin(), [](char c, std::byte byte) {
               return static_cast<std::byte>(c) == byte;
           });
}

Result<std::shared_ptr<SentScene>> write_scene(std::span<const std::byte> bytes) {
    Result<std::unique_ptr<const OwnFolder>> folder = OwnFolder::make("scene");
    if (!folder) return fail(folder.error());
    const fs::path file = (*folder)->path() / (is_glb(bytes) ? "scene.glb" : "scene.gltf");
    if (auto written = write_file_atomically(file, bytes); !written) return fail(written.error());
    return std::make_shared<SentScene>(std::move(*folder), file);
}

}  // namespace

/// With mutex_ locked.
std::shared_ptr<SentScene> SceneCache::find(const std::string& sha256) {
    const auto known = std::find_if(
        scenes_.begin(), scenes_.end(), [&](const Kept& kept) { return kept.sha256 == sha256; });
    if (known == scenes_.end()) return nullptr;
    std::rotate(scenes_.begin(), known, known + 1);
    return scenes_.front().scene;
}

Result<std::shared_ptr<SentScene>> SceneCache::scene_of(const std::string& sha256,
                                                        std::span<const std::byte> bytes) {
    {
        const std::lock_guard lock(mutex_);
        if (auto known = find(sha256)) return known;
    }
    Result<std::shared_ptr<SentScene>> sent = write_scene(bytes);
    if (!sent) return sent;
    std::deque<Kept> closed;  // goes when nobody holds the lock
    const std::lock_guard lock(mutex_);
    if (auto known = find(sha256)) return known;  // another request was faster
    while (!scenes_.empty() && scenes_.size() >= max_count_) {
        closed.push_back(std::move(scenes_.back()));
        scenes_.pop_back();
    }
    scenes_.push_front({sha256, *sent});
    return sent;
}

void SceneCache::forget(const SentScene& scene) {
    std::shared_ptr<SentScene> closed;
    const std::lock_guard lock(mutex_);
    const auto known = std::find_if(scenes_.begin(), scenes_.end(), [&](const Kept& kept) {
        return kept.scene.get() == &scene;
    });
    if (known == scenes_.end()) return;
    closed = std::move(known->scene);
    scenes_.erase(known);
}

size_t SceneCache::count() const {
    const std::lock_guard lock(mutex_);
    return scenes_.size();
}

}  // namespace obscura::serve
