// base/unset_array.cpp - allocates memory in large pages.
// SPDX-License-Identifier: Apache-2.0
#include "base/unset_array.h"

#include <cstdlib>
#include <new>
#include <sys/mman.h>

namespace obscura {

void* allocate_large_pages(size_t bytes) {
    constexpr size_t page = 2U << 20U;
    const size_t whole = (bytes + page - 1) / page * page;
    void* memory = std::aligned_alloc(page, whole);
    if (memory == nullptr) throw std::bad_alloc();
    madvise(memory, whole, MADV_HUGEPAGE);  // a hint: if refused, small pages will do
    return memory;
}

void free_large_pages(void* memory) {
    std::free(memory);
}

}  // namespace obscura
