// serve/service.h - what the server can do, whatever protocol asks for it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/json/json.h"

#include "serve/guard.h"
#include "serve/known_files.h"
#include "serve/viewer.h"
#include <map>
#include <memory>
#include <mutex>
#include <string>

namespace obscura::serve {

/// What the service is given.
struct ServiceOptions {
    std::vector<std::filesystem::path> roots;  ///< folders whose files clients may name
    uint64_t max_upload = 1ULL << 30U;         ///< bytes
    OptionReader options;
    std::string ocio_file = {};  ///< of all pictures; empty: as DisplayOptions say
};

/// The viewers of all clients, and the files that they may name. Any thread may call.
class Service {
public:
    explicit Service(ServiceOptions options);

    KnownFiles& files() { return files_; }
    /// {"files": [{"file", "kind"}]}: what is below the roots.
    Json list_files() const;
    /// Displays and their views, built-in environments, layers.
    ///
    /// Errors  78 E-OCIO-FILE
    Result<Json> choices() const;

    /// Opens an asset for a client: {"view", "asset", "camera"}. There are eight at most: the one
    /// that was not asked for longest is closed.
    ///
    /// Errors  those of KnownFiles::find and Viewer::open
    Result<Json> open_view(const std::string& file);
    /// Takes a wish: {"wish", "command"}.
    ///
    /// Errors  64 E-SERVE-UNKNOWN no such view; those of OptionReader::request and KnownFiles::find
    Result<Json> wish(const std::string& view, const Options& options);
    /// Errors  64 E-SERVE-UNKNOWN
    Result<std::shared_ptr<Viewer>> viewer(const std::string& view) const;
    Result<void> close_view(const std::string& view);
    /// An error of a view's images as its client is told it: with the names of files that the
    /// client knows, not where they lie.
    Error told(const std::string& view, Error error) const;

    /// A request for an image of a scene, by a client's options.
    ///
    /// Errors  those of with_files_found and OptionReader::request
    Result<RenderRequest> request(const std::filesystem::path& scene, const Options& options) const;
    /// Bytes of a file that a client sends, at most.
    uint64_t max_upload() const { return options_.max_upload; }

    /// Options whose files were found below the roots.
    ///
    /// Errors  64 E-USAGE-*; those of KnownFiles::find
    Result<Options> with_files_found(const Options& options) const;

private:
    struct Open {
        std::string file;  ///< as the client said it
        std::filesystem::path scene;
        std::map<std::string, std::string> names;  ///< of files, as the client says them
        std::shared_ptr<Viewer> viewer;
        int wishes = 0;
    };

    Result<Open> find_open(const std::string& view) const;
    std::shared_ptr<Viewer> add(Open&& open, std::string& id);

    const ServiceOptions options_;
    KnownFiles files_;
    mutable std::mutex mutex_;  ///< of what follows
    std::map<std::string, Open> views_;
    int opened_ = 0;
    /// In the ids of views, so that those of a server before this one are unknown to it.
    const std::string run_ = random_token().substr(0, 6);
};

}  // namespace obscura::serve
