// gltf/parse/document_animations.h - reads skins and animations.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/parse/document_reading.h"

namespace obscura::gltf {

void read_skins(DocumentReading& reading);
void read_animations(DocumentReading& reading);

}  // namespace obscura::gltf
