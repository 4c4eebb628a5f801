// session/library_request.h - checks a library caller's request by the rules of options.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "session/render_request.h"

#include <obscura/session.h>

namespace obscura {

/// The options with which the file is read.
gltf::LoadOptions load_options_of(const v0::AssetOptions& options);

/// Errors  64 E-USAGE-RANGE
Result<void> check_asset_options(const v0::AssetOptions& options);

/// Everything that an image is asked for, except outputs and the file.
///
/// Errors  64 E-USAGE-RANGE a number is out of its range, E-USAGE-CHOICE an unknown name,
///         E-USAGE-CONFLICT fields that exclude each other, E-AOV-NAME; `where` names the field
Result<RenderRequest> request_of(const v0::View& view,
                                 const v0::Look& look,
                                 const v0::Sampling& sampling,
                                 const v0::Control& control);

/// How an image becomes a file for a display, without the display's transform.
///
/// Errors  64 E-USAGE-RANGE, E-USAGE-CONFLICT
Result<DisplayEncoding> encoding_of(const v0::WriteOptions& options);

}  // namespace obscura
