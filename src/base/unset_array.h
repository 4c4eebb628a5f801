// base/unset_array.h - a vector that does not clear its memory.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>
#include <vector>

namespace obscura {

/// std::allocator, but what is made without a value is left as it is.
template <typename T>
struct UnsetAllocator : std::allocator<T> {
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
