// serve/scene_cache.h - scenes that clients send with each request, read and built once.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/open_asset.h"

#include "serve/own_folder.h"
#include <deque>
#include <filesystem>
#include <memory>
#include <mutex>
#include <span>
#include <string>

namespace obscura::serve {

/// A scene that a client sent. Whoever uses the asset holds the lock.
struct SentScene {
    SentScene(std::unique_ptr<const OwnFolder>&& kept, std::filesystem::path sent)
        : folder(std::move(kept)), file(std::move(sent)), asset(file, {}) {}

    const std::unique_ptr<const OwnFolder> folder;
    const std::filesystem::path file;  ///< in the folder
    std::timed_mutex mutex;            ///< of `asset`
    OpenAsset asset;
};

/// The latest few scenes, by their content. Any thread may call.
class SceneCache {
public:
    explicit SceneCache(size_t max_count = 4) : max_count_(max_count) {}

    /// The scene of these bytes, a .gltf or .glb; one that is new takes the place of the one that
    /// nobody asked for longest. It is not opened yet.
    ///
    /// In      sha256: of the bytes
    /// Errors  74 E-OUT-WRITE no folder for temporary files; those of write_file_atomically
    Result<std::shared_ptr<SentScene>> scene_of(const std::string& sha256,
                                                std::span<const std::byte> bytes);
    /// Makes room: what cannot be shown need not be kept. Who holds the scene keeps it.
    void forget(const SentScene& scene);
    size_t count() const;

private:
    struct Kept {
        std::string sha256;
        std::shared_ptr<SentScene> scene;
    };

    std::shared_ptr<SentScene> find(const std::string& sha256);

    const size_t max_count_;
    mutable std::mutex mutex_;
    std::deque<Kept> scenes_;  ///< the latest first
};

}  // namespace obscura::serve
