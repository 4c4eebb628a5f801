// gltf/parse/document_splats.h - reads KHR_gaussian_splatting of a primitive.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/parse/document_reading.h"

namespace obscura::gltf {

/// KHR_gaussian_splatting of a primitive whose attributes and mode are read.
void read_splats(const ModelElement& primitive, GltfPrimitive& out);

/// Where the number of an attribute of splats is kept; nullptr: the name is another one.
int* splat_slot(GltfSplatAttributes& attributes, const std::string& name);

/// "SH_DEGREE_2_COEF_4"
std::string splat_harmonic_name(int degree, int number);

}  // namespace obscura::gltf
