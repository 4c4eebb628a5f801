// image/process_settings.h - process-wide settings of the image libraries.
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace obscura {

/// For programs, at their start, before there are other threads; libraries must not call it.
///
/// Removes the environment variables that name folders from which OpenImageIO would load plug-ins:
/// OIIO_LIBRARY_PATH, and LD_LIBRARY_PATH, which the dynamic linker has already read. From then on
/// image/ also changes process-wide settings: OpenImageIO starts no threads and searches no
/// plug-ins, OpenEXR has threads to compress large images.
void own_process_settings();

/// True after own_process_settings().
bool owns_process_settings();

}  // namespace obscura
