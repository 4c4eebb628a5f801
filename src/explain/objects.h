// explain/objects.h - the objects near a ray, each worked out, in the order in which it meets them.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "explain/pixel_report.h"

namespace obscura {

/// Fills the report's objects, and how many are not among them.
///
/// In      report: its ray and the renderer's hit; most: objects that are listed, those that are
///         met before the others. A scene that has no more is listed whole
/// Out     report.objects, more_near, elsewhere, disagrees
void list_objects(const TrueScene& scene, size_t most, PixelReport& report);

}  // namespace obscura
