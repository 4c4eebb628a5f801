// session/image_layers.h - the layers of a film as files have them, with what Cryptomatte says.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "film/film.h"
#include "image/layers.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace obscura {

/// The layers of a film, whose pixels move. Those of Cryptomatte have its attributes; a name that
/// is empty stands for nothing that could be picked, and is left out of their manifests.
///
/// In      manifest: the name of a file beside the image with the manifest of all layers; empty:
///         each layer's is in the header
std::vector<ImageLayer> image_layers(std::vector<FilmLayer> layers, const std::string& manifest);

/// The text of a file with the manifest of all Cryptomatte layers: ids depend on names alone, so
/// that one list serves all.
std::string cryptomatte_document(std::span<const FilmLayer> layers);

/// Memory of all pixels.
size_t layer_bytes(std::span<const FilmLayer> layers);

}  // namespace obscura
