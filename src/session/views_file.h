// session/views_file.h - reads the views of --views from JSON.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/render_request.h"

namespace obscura {

/// Reads the file of ListRequest::views_file into ListRequest::views: {"views": [...]}, with the
/// keys that docs/many_images.md lists. What a view does not say is as the request says.
///
/// Errors  67 E-VIEWS-MISSING the file cannot be read; 65 E-JSON-*, E-VIEWS-KEY a key that there is
///         not, E-VIEWS-VALUE, and those of load_camera_json for its keys
Result<void> load_views(RenderRequest& request, Log& log);

}  // namespace obscura
