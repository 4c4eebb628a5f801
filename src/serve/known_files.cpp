// serve/known_files.cpp - the files that clients may name.
// SPDX-License-Identifier: Apache-2.0
#include "serve/known_files.h"

#include "base/descriptor.h"
#include "base/log.h"
#include "base/sha256.h"
#include "base/text.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <fcntl.h>
#include <fnmatch.h>
#include <system_error>
#include <unistd.h>

namespace obscura::serve {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view upload_prefix = "upload:";
constexpr size_t longest_list = 10000;
constexpr size_t max_entries = 200000;  ///< that are looked at below a root
constexpr int deepest_folder = 6;

std::string lower_ending(const fs::path& file) {
    std::string ending = file.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    return ending;
}

/// Whether a file, with its links followed, lies below a folder.
bool is_below(const fs::path& file, const fs::path& folder) {
    const auto [end, at] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
    return end == folder.end() && at != file.end();
}

tl::unexpected<Error> refused(const std::string& name) {
    return fail(ExitCode::refused,
                "E-URI-REFUSED",
                escape_control(name),
                "the name leads out of the folders that the server shows");
}

/// The last part of a name, which may have come from any system.
std::string plain_name(const std::string& name) {
    const size_t slash = name.find_last_of("/\\");
    return slash == std::string::npos ? name : name.substr(slash + 1);
}

bool is_a_name(const std::string& name) {
    constexpr size_t longest = 200;
    const bool is_plain = std::none_of(name.begin(), name.end(), [](char c) {
        return static_cast<unsigned char>(c) < ' ' || c == '\x7f';
    });
    return is_plain && name.size() <= longest && !name.starts_with('.');
}

tl::unexpected<Error> not_written(const fs::path& file) {
    return fail(ExitCode::io_error,
                "E-OUT-WRITE",
                file.string(),
                std::error_code(errno, std::generic_category()).message());
}

/// A file that is removed unless it went elsewhere.
struct PartOfUpload {
    fs::path path;
    ~PartOfUpload() {
        std::error_code ignored;
        fs::remove(path, ignored);
    }
};

}  // namespace

bool is_upload(std::string_view name) {
    return name.starts_with(upload_prefix);
}

std::optional<FileKind> kind_of(const fs::path& file) {
    const std::string ending = lower_ending(file);
    if (ending == ".glb" || ending == ".gltf") return FileKind::model;
    constexpr std::array<std::string_view, 3> environments = {".hdr", ".exr", ".pic"};
    const bool is_one =
        std::find(environments.begin(), environments.end(), ending) != environments.end();
    return is_one ? std::optional(FileKind::environment) : std::nullopt;
}

KnownFiles::KnownFiles(std::vector<fs::path> roots, uint64_t max_upload)
    : roots_(std::move(roots)), max_upload_(max_upload) {
    for (fs::path& root : roots_) {
        std::error_code error;
        const fs::path real = fs::canonical(root, error);
        if (!error) root = real;
    }
}

std::vector<KnownFile> KnownFiles::list() const {
    std::vector<KnownFile> out;
    for (const fs::path& root : roots_) {
        std::error_code error;
        fs::recursive_directory_iterator at(
            root, fs::directory_options::skip_permission_denied, error);
        size_t seen = 0;
        for (; !error && at != fs::recursive_directory_iterator() && seen < max_entries;
             at.increment(error), ++seen) {
            if (at->path().filename().string().starts_with('.') || at.depth() > deepest_folder)
                at.disable_recursion_pending();
            const auto kind = kind_of(at->path());
            std::error_code ignored;
            if (!kind || !at->is_regular_file(ignored)) continue;
            const std::string name = at->path().lexically_relative(root).string();
            if (at->is_symlink(ignored) && !find(name)) continue;
            out.push_back({name, *kind});
        }
    }
    std::sort(out.begin(), out.end(), [](const KnownFile& a, const KnownFile& b) {
        return a.name < b.name;
    });
    const auto end = std::unique(
        out.begin(), out.end(), [](const auto& a, const auto& b) { return a.name == b.name; });
    out.erase(end, out.end());
    if (out.size() > longest_list) out.resize(longest_list);
    return out;
}

Result<fs::path> KnownFiles::find(const std::string& name) const {
    if (name.find('\0') != std::string::npos) return refused(name);
    std::vector<fs::path> folders = roots_;
    std::string inside = name;
    if (is_upload(name)) {
        const std::lock_guard lock(mutex_);
        folders.clear();
        if (folder_ != nullptr) folders.push_back(folder_->path());
        inside = name.substr(upload_prefix.size());
    }
    if (inside.empty() || fs::path(inside).is_absolute()) return refused(name);
    bool leads_out = false;
    for (const fs::path& folder : folders) {
        std::error_code error;
        const fs::path file = fs::canonical(folder / inside, error);
        if (error) continue;
        if (!is_below(file, folder)) {
            leads_out = true;
        } else if (fs::is_regular_file(file, error)) {
            return file;
        }
    }
    const fs::path plain = fs::path(inside).lexically_normal();
    if (leads_out || *plain.begin() == "..") return refused(name);
    return fail(ExitCode::missing_scene, "E-SCENE-MISSING", escape_control(name), "not found");
}

/// Among the files of list(): what a pattern costs does not depend on the pattern.
std::vector<std::string> KnownFiles::match(const std::string& pattern) const {
    std::vector<std::string> out;
    for (const KnownFile& file : list()) {
        const bool fits =
            ::fnmatch(pattern.c_str(), file.name.c_str(), FNM_PATHNAME | FNM_PERIOD) == 0;
        if (fits && file.kind == FileKind::model) out.push_back(file.name);
    }
    return out;
}

Result<fs::path> KnownFiles::new_part() {
    const std::lock_guard lock(mutex_);
    if (folder_ == nullptr) {
        Result<std::unique_ptr<const OwnFolder>> folder = OwnFolder::make("uploads");
        if (!folder) return fail(folder.error());
        folder_ = std::move(*folder);
    }
    return folder_->path() / ("part" + std::to_string(++parts_));
}

/// With mutex_ locked.
void KnownFiles::make_room(uint64_t bytes) {
    while (!uploads_.empty() && bytes_ + bytes > max_upload_) {
        std::error_code ignored;
        fs::remove_all(folder_->path() / uploads_.front().sha256, ignored);
        bytes_ -= uploads_.front().bytes;
        uploads_.pop_front();
    }
}

Result<std::string> KnownFiles::enter(const fs::path& part, const std::string& name) {
    const auto digest = digest_file(part);
    if (!digest) return not_written(part);
    const std::lock_guard lock(mutex_);
    const fs::path file = folder_->path() / digest->sha256 / name;
    std::error_code error;
    const auto known = std::find_if(uploads_.begin(), uploads_.end(), [&](const Upload& one) {
        return one.sha256 == digest->sha256;
    });
    if (known != uploads_.end()) {  // under another name it is the same file
        std::rotate(known, known + 1, uploads_.end());
        const fs::path kept = fs::directory_iterator(file.parent_path(), error)->path();
        if (!error && !fs::exists(file, error)) fs::create_hard_link(kept, file, error);
    } else {
        make_room(digest->bytes);
        fs::create_directories(file.parent_path(), error);
        fs::rename(part, file, error);
        uploads_.push_back({digest->sha256, digest->bytes});
        bytes_ += digest->bytes;
    }
    if (error) return fail(ExitCode::io_error, "E-OUT-WRITE", name, error.message());
    return std::string(upload_prefix) + digest->sha256 + "/" + name;
}

Result<std::string> KnownFiles::keep(const std::string& name,
                                     const std::function<Result<void>(const ByteSink&)>& send) {
    const std::string plain = plain_name(name);
    if (!is_a_name(plain) || !kind_of(plain)) {
        return fail(ExitCode::usage,
                    "E-SERVE-NAME",
                    escape_control(plain),
                    "expected the name of a .glb, .gltf, .hdr or .exr file");
    }
    const Result<fs::path> path = new_part();
    if (!path) return fail(path.error());
    const PartOfUpload part{*path};
    uint64_t bytes = 0;
    {
        constexpr int flags = O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode = 0600;
        const Descriptor file(::open(part.path.c_str(), flags, mode));
        if (!file.is_open()) return not_written(part.path);
        const auto sink = [&](std::span<const std::byte> more) -> Result<void> {
            bytes += more.size();
            if (bytes > max_upload_) {
                return fail(ExitCode::refused,
                            "E-SERVE-SIZE",
                            plain,
                            "the file is larger than the server takes: --max-upload");
            }
            return write_fully(file.number(), more, part.path);
        };
        if (auto sent = send(sink); !sent) return fail(sent.error());
    }
    return enter(part.path, plain);
}

}  // namespace obscura::serve
