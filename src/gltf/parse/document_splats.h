// gltf/parse/document_splats.h - reads what makes Gaussian splats of a primitive's points.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/parse/document_reading.h"

namespace obscura {

/// KHR_gaussian_splatting of a primitive whose attributes and mode are read.
void read_splats(const ModelElement& primitive, GltfPrimitive& out);

/// Where the number of an attribute of splats is kept; nullptr: the name is another one.
int* splat_slot(GltfSplatAttributes& attributes, const std::string& name);

/// "SH_DEGREE_2_COEF_4"
std::string splat_harmonic_name(int degree, int number);

}  // namespace obscura
