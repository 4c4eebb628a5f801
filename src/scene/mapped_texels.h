// scene/mapped_texels.h - texels that lie in files and come into memory where rays look at them.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace obscura {

/// Texels in one range of addresses, in which files appear. The system reads a page of 4 KiB when a
/// ray first looks at it. When more of them are in memory than there may be, all are given back:
/// those that are still looked at come again at once, mostly from the system's own cache of files,
/// which it empties where memory is short. Rays read memory in any case, so look-ups are as fast,
/// and have the same bits.
class MappedTexels {
public:
    /// What a texel file's texels begin at, and multiples of: pages.
    static constexpr size_t texels_per_page = 1024;

    /// Takes addresses, but no memory.
    ///
    /// In      max_bytes: of pages in memory, about: looked at many times a second
    /// Errors  33 E-MEMORY there are not as many addresses
    static Result<std::shared_ptr<MappedTexels>> reserve(size_t texels, uint64_t max_bytes);
    ~MappedTexels();
    MappedTexels(const MappedTexels&) = delete;
    MappedTexels& operator=(const MappedTexels&) = delete;

    const uint32_t* data() const { return static_cast<const uint32_t*>(memory_); }
    size_t size() const { return texels_; }

    /// Makes a file's texels appear. They must stay as they are: the file may be removed or
    /// replaced, but not written to.
    ///
    /// In      first: a multiple of texels_per_page; file_offset: in bytes, likewise of pages
    /// Errors  67 E-RES-MISSING the file cannot be opened; 33 E-MEMORY
    Result<void> map(size_t first,
                     size_t texels,
                     const std::filesystem::path& file,
                     uint64_t file_offset);
    /// Memory in place of a file, which stays.
    ///
    /// In      first: a multiple of texels_per_page
    /// Errors  33 E-MEMORY
    Result<uint32_t*> memory(size_t first, size_t texels);

private:
    MappedTexels(void* memory, size_t texels, uint64_t max_bytes);

    struct Range {
        size_t first, texels;
    };

    void keep_small();

    void* const memory_;
    const size_t texels_;
    const uint64_t max_bytes_;
    const uint64_t other_bytes_;  ///< pages of other files in memory, such as libraries
    std::mutex mutex_;            ///< of what follows
    std::vector<Range> files_;
    std::condition_variable ended_;
    bool is_over_ = false;
    std::thread keeper_;
};

}  // namespace obscura
