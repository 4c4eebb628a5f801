// explain/objects.h - lists the objects near a ray, those that it meets first.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "explain/pixel_report.h"

namespace obscura {

/// Fills the report's objects, and counts those that are not listed.
///
/// In      report: its ray and the renderer's hit; max_objects: limit on listed objects, met ones
///         first. A scene that has no more is listed whole
/// Out     report.objects, more_near, elsewhere, disagrees
void list_objects(const crosscheck::TrueScene& scene, size_t max_objects, PixelReport& report);

}  // namespace obscura
