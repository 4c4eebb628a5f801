// serve/route_drake.h - the route of Drake's glTF render client-server protocol.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "serve/http.h"
#include "serve/scene_cache.h"
#include "serve/service.h"
#include <atomic>

namespace obscura::serve {

/// POST /render: a form with a scene becomes an image; docs/drake.md. All that is handed over lives
/// as long as the server does.
///
/// In      stop: true: the server ends, and with it the images that are being rendered
/// Source  Drake, "glTF Render Client-Server API"
void route_drake(Routes& routes,
                 const Service& service,
                 SceneCache& scenes,
                 const std::atomic<bool>& stop);

}  // namespace obscura::serve
