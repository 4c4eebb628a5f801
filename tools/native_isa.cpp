// tools/native_isa.cpp - prints the widest instruction set of this CPU that the stages know.
// SPDX-License-Identifier: Apache-2.0
#include "base/cpu.h"

#include <cstdio>

int main() {
    const char* const widest = obscura::cpu_has_avx512() ? "avx512"
                               : obscura::cpu_has_avx2() ? "avx2"
                                                         : "baseline";
    std::fputs(widest, stdout);
}
