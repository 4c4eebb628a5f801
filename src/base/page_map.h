// base/page_map.h - which pages of its memory the process has used.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/unset_array.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace obscura {

/// The pages of some memory when PageMap looked at it. Pages that nobody has written or read yet
/// are 0; to read them would bring them in, one page fault and, on some systems, 4 KiB each.
class UsedPages {
public:
    bool all() const { return unused_.empty(); }
    /// In      part: of what was looked at
    bool has_all_of(std::span<const float> part) const;

    /// Copies values, but does not read unused pages.
    ///
    /// In      from: part of what was looked at
    ///         to: room for as many
    void copy(std::span<const float> from, float* to) const;

private:
    friend class PageMap;

    size_t page_of(const float* value) const;

    uintptr_t begin_ = 0;            ///< the first page's address
    std::vector<bool> unused_ = {};  ///< by page; empty: none
};

/// Where the system tells which pages a process has used; elsewhere all count as used.
///
/// Source  Linux, Documentation/admin-guide/mm/pagemap.rst
class PageMap {
public:
    PageMap();
    ~PageMap();
    PageMap(const PageMap&) = delete;
    PageMap& operator=(const PageMap&) = delete;

    /// Whether an array's memory is all its own and of no file.
    static bool can_look_at(const UnsetArray<float>& array) {
        return array.capacity() >= LargePageAllocator<float>::smallest_large / sizeof(float);
    }

    /// In      memory: of an array that it can look at
    UsedPages look_at(std::span<const float> memory) const;

private:
    int file_;
};

}  // namespace obscura
