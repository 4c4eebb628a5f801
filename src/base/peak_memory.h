// base/peak_memory.h - the most memory that this process has held.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace obscura {

/// Largest resident memory of this process so far, or since reset_peak_memory().
size_t peak_memory_bytes();

/// Counts the peak anew from what is resident now. Returns false where the system does not let us
/// (it needs Linux and a writable /proc).
bool reset_peak_memory();

}  // namespace obscura
