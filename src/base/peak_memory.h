// base/peak_memory.h - the peak memory of this process.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace obscura {

/// Largest resident memory of this process so far, or since reset_peak_memory().
size_t peak_memory_bytes();

/// Resets the peak to the current resident memory. Returns false if the system does not allow it:
/// it needs Linux and a writable /proc.
bool reset_peak_memory();

}  // namespace obscura
