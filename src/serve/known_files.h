// serve/known_files.h - the files that clients may name: those below the roots, and uploads.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/atomic_file.h"

#include "serve/own_folder.h"
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace obscura::serve {

/// What a file is good for.
enum class FileKind { model, environment };

/// Whether a client names a file that was sent: "upload:<sha256>/shoe.glb".
bool is_upload(std::string_view name);

/// By the ending of its name; nothing: it is neither.
std::optional<FileKind> kind_of(const std::filesystem::path& file);

struct KnownFile {
    std::string name;  ///< as clients say it: "shoes/left.glb"
    FileKind kind = FileKind::model;
};

/// Names of clients become files, never outside the roots. Any thread may call.
class KnownFiles {
public:
    /// In      roots: folders; max_upload: bytes of a file, and of all uploads together
    KnownFiles(std::vector<std::filesystem::path> roots, uint64_t max_upload);
    KnownFiles(const KnownFiles&) = delete;
    KnownFiles& operator=(const KnownFiles&) = delete;

    /// The models and environments below the roots: at most 10,000, by their names.
    std::vector<KnownFile> list() const;

    /// The file of a name: below the first root that has it, or of an upload.
    ///
    /// Errors  77 E-URI-REFUSED the name leads out of the roots, also by a link;
    ///         66 E-SCENE-MISSING there is no such file
    Result<std::filesystem::path> find(const std::string& name) const;

    /// The models that find() finds and a pattern with *, ? and [...] as in a shell fits, by their
    /// names; at most 10,000.
    ///
    /// In      pattern: relative, without ..
    std::vector<std::string> match(const std::string& pattern) const;

    /// Keeps a file that a client sends; `send` hands over its bytes. The same bytes are kept once.
    /// Where all uploads together take too much, the oldest go.
    ///
    /// Out     the name by which clients find it
    /// Errors  64 E-SERVE-NAME a name without an ending that is known; 77 E-SERVE-SIZE;
    ///         74 E-OUT-WRITE; those of `send`
    Result<std::string> keep(const std::string& name,
                             const std::function<Result<void>(const ByteSink&)>& send);

private:
    struct Upload {
        std::string sha256;
        uint64_t bytes = 0;
    };

    Result<std::filesystem::path> new_part();
    Result<std::string> enter(const std::filesystem::path& part, const std::string& name);
    void make_room(uint64_t bytes);

    std::vector<std::filesystem::path> roots_;
    uint64_t max_upload_;
    mutable std::mutex mutex_;                 ///< of what follows
    std::unique_ptr<const OwnFolder> folder_;  ///< of uploads; null: there was none yet
    std::deque<Upload> uploads_;               ///< the oldest first
    uint64_t bytes_ = 0;                       ///< of all of them
    int parts_ = 0;                            ///< that were begun
};

}  // namespace obscura::serve
