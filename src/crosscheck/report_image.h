// crosscheck/report_image.h - a picture of where on the screen answers differ from the truth.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "crosscheck/check_scene.h"
#include "image/write.h"

namespace obscura {

/// Grey: all kernels agree (light: something is hit there); blue: another item at equal depth;
/// green: at an edge; yellow: between neighbours or beside an edge-on triangle; red: nothing
/// explains it. Black: no ray went there.
Picture screen_picture(const ScreenVerdicts& screen);

}  // namespace obscura
