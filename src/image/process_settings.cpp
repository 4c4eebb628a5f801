// image/process_settings.cpp - process-wide settings of the image libraries.
// SPDX-License-Identifier: Apache-2.0
#include "image/process_settings.h"

#include <atomic>
#include <cstdlib>

namespace obscura {

namespace {

std::atomic<bool> owned = false;

}  // namespace

void own_process_settings() {
    ::unsetenv("OIIO_LIBRARY_PATH");
    ::unsetenv("LD_LIBRARY_PATH");
    owned = true;
}

bool owns_process_settings() {
    return owned;
}

}  // namespace obscura
