// base/unset_array.cpp - allocates memory in large pages.
// SPDX-License-Identifier: Apache-2.0
#include "base/unset_array.h"

#include <cstdint>
#include <new>
#include <sys/mman.h>

namespace obscura {

namespace {

constexpr size_t large_page = 2U << 20U;

size_t whole_pages(size_t bytes) {
    return (bytes + large_page - 1) / large_page * large_page;
}

}  // namespace

void* allocate_large_pages(size_t bytes) {
    const size_t whole = whole_pages(bytes);
    void* const mapped = mmap(
        nullptr, whole + large_page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (mapped == MAP_FAILED) throw std::bad_alloc();
    auto* const begin = static_cast<std::byte*>(mapped);
    const size_t before =
        (large_page - reinterpret_cast<uintptr_t>(begin) % large_page) % large_page;
    if (before > 0) munmap(begin, before);
    std::byte* const memory = begin + before;
    munmap(memory + whole, large_page - before);
    madvise(memory, whole, MADV_HUGEPAGE);  // a hint: if refused, small pages will do
    return memory;
}

void free_large_pages(void* memory, size_t bytes) {
    munmap(memory, whole_pages(bytes));
}

void use_small_pages(void* memory, size_t bytes) {
    madvise(memory, whole_pages(bytes), MADV_NOHUGEPAGE);  // a hint, like the other
}

}  // namespace obscura
