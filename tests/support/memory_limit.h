// tests/support/memory_limit.h - makes large allocations of a test fail.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace obscura::test {

/// While one lives, allocations of this thread of at least so many bytes fail, in libraries too.
/// The program needs support/memory_limit.cpp.
class MemoryLimit {
public:
    explicit MemoryLimit(size_t bytes);
    ~MemoryLimit();
    MemoryLimit(const MemoryLimit&) = delete;
    MemoryLimit& operator=(const MemoryLimit&) = delete;
};

}  // namespace obscura::test
