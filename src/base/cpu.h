// base/cpu.h - detects the processor's instruction sets.
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace obscura {

bool cpu_has_sse42();
bool cpu_has_avx();
bool cpu_has_avx2();    ///< all of x86-64-v3
bool cpu_has_avx512();  ///< all of x86-64-v4

}  // namespace obscura
