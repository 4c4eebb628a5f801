// tests/support/memory_limit.cpp - a test program's allocator, in place of the library's.
// SPDX-License-Identifier: Apache-2.0
#include "support/memory_limit.h"

#include <cstdint>
#include <cstdlib>
#include <new>

namespace {

thread_local size_t refused_bytes = SIZE_MAX;

}  // namespace

obscura::test::MemoryLimit::MemoryLimit(size_t bytes) {
    refused_bytes = bytes;
}

obscura::test::MemoryLimit::~MemoryLimit() {
    refused_bytes = SIZE_MAX;
}

// The sanitizers' own form would not fit the operator delete below.
void* operator new(size_t bytes, const std::nothrow_t&) noexcept {
    return bytes >= refused_bytes ? nullptr : std::malloc(bytes == 0 ? 1 : bytes);
}

void* operator new(size_t bytes) {
    void* memory = operator new(bytes, std::nothrow);
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
}

void operator delete(void* memory) noexcept {
    std::free(memory);
}

void operator delete(void* memory, size_t) noexcept {
    std::free(memory);
}

void operator delete(void* memory, const std::nothrow_t&) noexcept {
    std::free(memory);
}
