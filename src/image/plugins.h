// image/plugins.h - keeps code that is not ours out of the process.
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace obscura {

/// Takes the variables out of the environment that name folders from which OpenImageIO would load
/// libraries as plug-ins: OIIO_LIBRARY_PATH, and LD_LIBRARY_PATH, whose meaning for the program
/// itself the dynamic linker has noted long before. Call it before there are other threads.
void ignore_plugin_paths();

}  // namespace obscura
