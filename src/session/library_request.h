// session/library_request.h - what a caller of the library asks for, checked as options are.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"

#include "session/render_request.h"
#include <obscura/session.h>

namespace obscura {

/// How the file is to be read.
LoadOptions load_options_of(const v0::AssetOptions& options);

/// Everything that an image is asked for, but outputs and the file.
///
/// Errors  64 E-USAGE-RANGE a number that is out of its range, E-USAGE-CHOICE a name that there is
///         not, E-USAGE-CONFLICT fields that exclude each other; `where` names the field
Result<RenderRequest> request_of(const v0::View& view,
                                 const v0::Look& look,
                                 const v0::Sampling& sampling,
                                 const v0::Control& control);

}  // namespace obscura
