// image/process_settings.h - what a program that owns its process lets the image libraries do.
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace obscura {

/// For a program at its start, before there are other threads; a library must not call it.
///
/// Takes the variables out of the environment that name folders from which OpenImageIO would load
/// libraries as plug-ins: OIIO_LIBRARY_PATH, and LD_LIBRARY_PATH, whose meaning for the program
/// itself the dynamic linker has noted long before. From now on this room also sets what holds for
/// the whole process, where it needs it: OpenImageIO makes no threads of its own and looks for no
/// plug-ins, OpenEXR has threads to compress large images on.
void own_process_settings();

/// True after own_process_settings().
bool owns_process_settings();

}  // namespace obscura
