// base/unset_array.h - vectors for large arrays: in large pages, optionally uninitialised.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace obscura {

/// Zeros, aligned to a large page and, where the system has them, in large pages: one page fault
/// then brings in 2 MiB, instead of 512 faults. Throws std::bad_alloc.
void* allocate_large_pages(size_t bytes);
void free_large_pages(void* memory, size_t bytes);
/// Small pages for memory of allocate_large_pages that nobody has written yet, with its bytes.
void use_small_pages(void* memory, size_t bytes);

/// std::allocator, but with large pages for two large pages or more: random reads then cause fewer
/// TLB misses.
template <typename T>
struct LargePageAllocator : std::allocator<T> {
    static constexpr size_t smallest_large = 4U << 20U;  // two large pages; less would waste one

    T* allocate(size_t count) {
        const bool large = count >= smallest_large / sizeof(T);
        if (!large || count > PTRDIFF_MAX / sizeof(T)) return std::allocator<T>::allocate(count);
        return static_cast<T*>(allocate_large_pages(count * sizeof(T)));
    }

    void deallocate(T* memory, size_t count) {
        const bool large = count >= smallest_large / sizeof(T);
        if (large) {
            free_large_pages(memory, count * sizeof(T));
        } else {
            std::allocator<T>::deallocate(memory, count);
        }
    }
};

/// A vector in large pages.
template <typename T>
using LargeArray = std::vector<T, LargePageAllocator<T>>;

/// The same, but elements without a value are left uninitialised.
template <typename T>
struct UnsetAllocator : LargePageAllocator<T> {
    template <typename U, typename... Arguments>
    void construct(U* at, Arguments&&... arguments) {
        if constexpr (sizeof...(Arguments) == 0) {
            ::new (static_cast<void*>(at)) U;
        } else {
            std::construct_at(at, std::forward<Arguments>(arguments)...);
        }
    }
};

/// A vector whose resize leaves numbers uninitialised. The threads that write them first then fault
/// in the memory in parallel, instead of waiting for one thread to clear it.
template <typename T>
using UnsetArray = std::vector<T, UnsetAllocator<T>>;

/// An array of zeros. A large one costs memory and time only where it is written, in small pages.
template <typename T>
UnsetArray<T> zero_array(size_t count) {
    UnsetArray<T> out(count);
    if (count < LargePageAllocator<T>::smallest_large / sizeof(T)) {
        std::fill(out.begin(), out.end(), T{});
    } else {
        use_small_pages(out.data(), count * sizeof(T));
    }
    return out;
}

}  // namespace obscura
