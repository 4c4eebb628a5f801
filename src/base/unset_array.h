// base/unset_array.h - vectors for large arrays: in large pages, and not cleared.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace obscura {

/// Memory that is aligned to a large page and, where the system has them, consists of such: 2 MiB
/// are then brought in by one page fault in place of 512. Errors: throws std::bad_alloc
void* allocate_large_pages(size_t bytes);
void free_large_pages(void* memory);

/// std::allocator, but from two large pages on in such: what is read in no order then stays within
/// reach of the processor's table of pages.
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
            free_large_pages(memory);
        } else {
            std::allocator<T>::deallocate(memory, count);
        }
    }
};

/// A vector in large pages.
template <typename T>
using LargeArray = std::vector<T, LargePageAllocator<T>>;

/// The same, but what is made without a value is left as it is.
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

/// A vector whose resize leaves numbers unset: the threads that write them first bring in their
/// memory, all at once, where one thread would clear it before the others may begin.
template <typename T>
using UnsetArray = std::vector<T, UnsetAllocator<T>>;

}  // namespace obscura
