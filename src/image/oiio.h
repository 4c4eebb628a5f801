// image/oiio.h - opens the module with OpenImageIO when an image first needs it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "image/oiio_module.h"
#include "image/output_format.h"

namespace obscura {

/// OpenImageIO. The first call opens the module, which is a third of a second of work: OpenImageIO
/// brings some 260 libraries. Thread-safe; all callers wait for the first.
///
/// Out     what stays open until the process ends
/// Errors  69 E-OIIO the module is not there or cannot be opened; 33 E-MEM the limit on the address
///         space leaves too little; the same each time
const Result<const OiioModule*>& oiio_module();

/// Begins to open the module beside what else there is to do; does nothing from the second call on,
/// or where the address space is limited.
void open_oiio_ahead();

/// Waits until what open_oiio_ahead has begun is done. A program calls it in the end, before it
/// exits: what the libraries register for the exit is called while the others are still being
/// opened, otherwise.
void wait_for_oiio();

/// True for formats that OpenImageIO writes; the others have libraries of their own.
bool is_written_by_oiio(OutputFormat format);

}  // namespace obscura
