// explain/names.h - what objects and materials are called in a report.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "crosscheck/truth.h"

#include <string>

namespace obscura {

/// "triangle 12 of node 3 'Wall'"; names from the file are escaped.
std::string name_of_item(const TrueScene& scene, const Item& item);

/// Row of the item's material in the scene.
const Material& material_of(const Scene& scene, const Item& item);
std::string name_of_material(const Scene& scene, const Item& item);

}  // namespace obscura
