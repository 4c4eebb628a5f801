// explain/names.h - names of objects and materials in a report.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "crosscheck/truth.h"

#include <string>

namespace obscura {

/// "triangle 12 of node 3 'Wall'"; names from the file are escaped.
std::string name_of_item(const crosscheck::TrueScene& scene, const crosscheck::Item& item);

/// Index of the item's material in the scene.
const Material& material_of(const Scene& scene, const crosscheck::Item& item);
std::string name_of_material(const Scene& scene, const crosscheck::Item& item);

}  // namespace obscura
