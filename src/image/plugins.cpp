// image/plugins.cpp - keeps code that is not ours out of the process.
// SPDX-License-Identifier: Apache-2.0
#include "image/plugins.h"

#include <cstdlib>

namespace obscura {

void ignore_plugin_paths() {
    ::unsetenv("OIIO_LIBRARY_PATH");
    ::unsetenv("LD_LIBRARY_PATH");
}

}  // namespace obscura
