// session/image_layers.cpp - the layers of a film as files have them, with what Cryptomatte says.
// SPDX-License-Identifier: Apache-2.0
#include "session/image_layers.h"

#include "film/cryptomatte.h"

#include <algorithm>
#include <iterator>
#include <utility>
#include <variant>

namespace obscura {

namespace {

/// Adds the names that stand for something.
void add_names(const FilmLayer& from, std::vector<std::string>& to) {
    std::copy_if(
        from.names.begin(), from.names.end(), std::back_inserter(to), [](const std::string& name) {
            return !name.empty();
        });
}

std::vector<CryptomatteAttribute> attributes_of(const std::string& layer,
                                                const std::vector<std::string>& names,
                                                const std::string& manifest) {
    if (!manifest.empty()) return cryptomatte_file_attributes(layer, manifest);
    return cryptomatte_attributes(layer, cryptomatte_manifest(names));
}

ImageLayer image_layer(FilmLayer&& from, const std::string& manifest) {
    ImageLayer out;
    if (is_cryptomatte(from.layer)) {
        add_names(from, out.names);
        for (CryptomatteAttribute& attribute : attributes_of(from.layer.name, out.names, manifest))
            out.metadata.emplace_back(std::move(attribute.name), std::move(attribute.text));
    }
    out.name = std::move(from.layer.name);
    out.channels = std::move(from.layer.channels);
    out.kind = from.layer.kind;
    out.pixels = std::move(from.pixels);
    if (const auto* share = std::get_if<LightLayer>(&from.layer.source))
        out.expression = share->shown;
    out.reduction = std::move(from.layer.reduction);
    return out;
}

}  // namespace

std::vector<ImageLayer> image_layers(std::vector<FilmLayer> layers, const std::string& manifest) {
    std::vector<ImageLayer> out;
    for (FilmLayer& layer : layers)
        out.push_back(image_layer(std::move(layer), manifest));
    return out;
}

std::string cryptomatte_document(std::span<const FilmLayer> layers) {
    std::vector<std::string> names;
    for (const FilmLayer& layer : layers) {
        if (is_cryptomatte(layer.layer)) add_names(layer, names);
    }
    return cryptomatte_manifest_document(names);
}

size_t layer_bytes(std::span<const FilmLayer> layers) {
    size_t bytes = 0;
    for (const FilmLayer& layer : layers)
        bytes += layer.pixels.size() * sizeof(float);
    return bytes;
}

}  // namespace obscura
