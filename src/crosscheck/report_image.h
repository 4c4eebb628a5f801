// crosscheck/report_image.h - an image that shows where answers differ from the truth.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "crosscheck/check_scene.h"
#include "image/write.h"

namespace obscura::crosscheck {

/// Grey: all kernels agree (light: there is a hit); blue: another item at equal depth; green: at an
/// edge; yellow: between neighbours or beside an edge-on triangle; red: unexplained. Black: no ray
/// passed there.
OutputImage screen_image(const ScreenVerdicts& screen);

}  // namespace obscura::crosscheck
