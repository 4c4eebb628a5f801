// session/library_image.cpp - a finished image becomes the library's Image, and one to be written.
// SPDX-License-Identifier: Apache-2.0
#include "session/library_image.h"

#include "base/text.h"
#include "film/cryptomatte.h"
#include "image/channel_planes.h"

#include <algorithm>

namespace obscura {

namespace {

/// The library's kinds have the same order as ours.
static_assert(static_cast<int>(v0::LayerKind::id) == static_cast<int>(LayerKind::id) &&
              static_cast<int>(v0::LayerKind::data) == static_cast<int>(LayerKind::data));

std::string text_of(const AttributeValue& value) {
    return std::visit(
        [](const auto& from) {
            if constexpr (std::is_same_v<std::decay_t<decltype(from)>, std::string>) {
                return from;
            } else {
                return shortest(static_cast<double>(from));
            }
        },
        value);
}

std::vector<ImageAttribute> typed_attributes(
    const std::vector<std::pair<std::string, std::string>>& texts,
    const std::vector<ImageAttribute>& made) {
    std::vector<ImageAttribute> out;
    for (const auto& text : texts) {
        const auto same = std::find_if(made.begin(), made.end(), [&](const ImageAttribute& own) {
            return own.name == text.first && text_of(own.value) == text.second;
        });
        out.push_back(same != made.end() ? *same : ImageAttribute{text.first, text.second});
    }
    return out;
}

v0::Layer library_layer(const ImageLayer& from) {
    v0::Layer out;
    out.name = from.name;
    out.channels = from.channels;
    out.kind = static_cast<v0::LayerKind>(from.kind);
    out.reduction = from.reduction;
    out.expression = from.expression;
    out.pixels.resize(from.pixels.size());
    interleave_planes(from.pixels, from.channels.size(), out.pixels.data());
    for (const std::string& name : from.names)
        out.names.push_back({name, cryptomatte_id(cryptomatte_hash(name))});
    out.attributes = from.metadata;
    return out;
}

ImageLayer layer_to_write(const v0::Layer& from) {
    ImageLayer out;
    out.name = from.name;
    out.channels = from.channels;
    out.kind = static_cast<LayerKind>(from.kind);
    out.reduction = from.reduction;
    out.expression = from.expression;
    out.pixels.resize(from.pixels.size());
    separate_planes(from.pixels, from.channels.size(), out.pixels.data());
    out.metadata = from.attributes;
    return out;
}

}  // namespace

v0::Image library_image(const FinishedImage& finished,
                        const RenderRequest& request,
                        const ChosenCamera& camera) {
    const OutputImage& image = finished.image;
    v0::Image out;
    out.width = request.options.width;
    out.height = request.options.height;
    const ImagePart part = image.part_of.value_or(ImagePart{});
    out.part = {part.x, part.y, image.width, image.height};
    out.channels = image.channels;
    out.pixels.assign(image.pixels.begin(), image.pixels.end());
    for (const ImageLayer& layer : image.layers)
        out.layers.push_back(library_layer(layer));
    for (const ImageAttribute& attribute : finished.metadata.extra) {
        std::string text = text_of(attribute.value);
        if (!text.empty()) out.attributes.emplace_back(attribute.name, std::move(text));
    }
    out.source = std::make_shared<const v0::Image::Source>(
        v0::Image::Source{finished.metadata, request.options.integrator, camera.ev100});
    return out;
}

FinishedImage finished_image(const v0::Image& image) {
    FinishedImage finished;
    finished.metadata = image.source->metadata;
    finished.metadata.extra = typed_attributes(image.attributes, finished.metadata.extra);
    OutputImage& output = finished.image;
    output.width = image.part.width;
    output.height = image.part.height;
    output.channels = image.channels;
    output.pixels.assign(image.pixels.begin(), image.pixels.end());
    if (image.part.width != image.width || image.part.height != image.height) {
        output.part_of = ImagePart{image.width, image.height, image.part.x, image.part.y};
    }
    for (const v0::Layer& layer : image.layers)
        output.layers.push_back(layer_to_write(layer));
    return finished;
}

}  // namespace obscura
