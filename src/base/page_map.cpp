// base/page_map.cpp - which pages of its memory the process has used.
// SPDX-License-Identifier: Apache-2.0
#include "base/page_map.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <fcntl.h>
#include <unistd.h>

namespace obscura {

namespace {

uintptr_t page_bytes() {
    static const auto bytes = static_cast<uintptr_t>(sysconf(_SC_PAGESIZE));
    return bytes;
}

/// In memory, or in the swap.
bool is_used(uint64_t entry) {
    return (entry >> 62U) != 0;
}

}  // namespace

size_t UsedPages::page_of(const float* value) const {
    return (reinterpret_cast<uintptr_t>(value) - begin_) / page_bytes();
}

bool UsedPages::has_all_of(std::span<const float> part) const {
    if (all() || part.empty()) return true;
    const auto first = unused_.begin() + static_cast<ptrdiff_t>(page_of(&part.front()));
    const auto last = unused_.begin() + static_cast<ptrdiff_t>(page_of(&part.back()));
    return std::find(first, last + 1, true) == last + 1;
}

void UsedPages::copy(std::span<const float> from, float* to) const {
    while (!from.empty()) {
        const size_t page = page_of(from.data());
        const uintptr_t end = begin_ + (page + 1) * page_bytes();
        const size_t to_next = (end - reinterpret_cast<uintptr_t>(from.data())) / sizeof(float);
        const size_t count = all() ? from.size() : std::min(from.size(), to_next);
        if (all() || !unused_[page]) {
            std::memcpy(to, from.data(), count * sizeof(float));
        } else {
            std::fill_n(to, count, 0.0f);
        }
        from = from.subspan(count);
        to += count;
    }
}

// A child has other memory: each user opens the file for itself.
PageMap::PageMap() : file_(::open("/proc/self/pagemap", O_RDONLY | O_CLOEXEC)) {
    // A file that is not of this memory, as below an emulator, would take pixels for zeros.
    const std::array<float, 1> used = {1};
    if (look_at(used).all() || file_ < 0) return;
    ::close(file_);
    file_ = -1;
}

PageMap::~PageMap() {
    if (file_ >= 0) ::close(file_);
}

UsedPages PageMap::look_at(std::span<const float> memory) const {
    UsedPages out;
    if (file_ < 0 || memory.empty()) return out;
    const uintptr_t first = reinterpret_cast<uintptr_t>(memory.data()) / page_bytes();
    const uintptr_t last =
        (reinterpret_cast<uintptr_t>(memory.data()) + memory.size_bytes() - 1) / page_bytes();
    std::vector<uint64_t> entries(last - first + 1);
    const std::span<std::byte> bytes = std::as_writable_bytes(std::span(entries));
    const ssize_t got =
        ::pread(file_, bytes.data(), bytes.size(), static_cast<off_t>(first * sizeof(uint64_t)));
    if (got != static_cast<ssize_t>(bytes.size())) return out;
    if (std::all_of(entries.begin(), entries.end(), is_used)) return out;
    out.begin_ = first * page_bytes();
    for (const uint64_t entry : entries)
        out.unused_.push_back(!is_used(entry));
    return out;
}

}  // namespace obscura
