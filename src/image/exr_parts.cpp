// image/exr_parts.cpp - which channels of an image lie in which part of an OpenEXR file, and how.
// SPDX-License-Identifier: Apache-2.0
#include "image/exr_parts.h"

#include <algorithm>
#include <set>

namespace obscura {

namespace {

bool is_lossy(ExrCompression codec) {
    return codec >= ExrCompression::pxr24;
}

bool is_dwa(ExrCompression codec) {
    return codec == ExrCompression::dwaa || codec == ExrCompression::dwab;
}

/// PXR24 keeps 24 bits of a float. DWA keeps 16 of every channel whose name ends in R, G, B, Y, RY
/// or BY, and how much of the others is the library's choice. B44 leaves floats as they are.
bool rounds_floats(ExrCompression codec) {
    return codec == ExrCompression::pxr24 || is_dwa(codec);
}

bool has_kind(const std::vector<ExrGroup>& groups, bool color) {
    return std::any_of(groups.begin(), groups.end(), [&](const ExrGroup& group) {
        return (group.kind == LayerKind::color) == color;
    });
}

ExrCompression codec_for(const std::vector<ExrGroup>& groups, ExrCompression wanted) {
    if (!has_kind(groups, false) || !is_lossy(wanted)) return wanted;
    const bool is_mixed = has_kind(groups, true);
    return is_mixed && !rounds_floats(wanted) ? wanted : ExrCompression::zip;
}

ExrGroup beauty_of(const ExrContent& content) {
    return {&content.image.channels,
            &content.image.pixels,
            content.metadata.is_color ? LayerKind::color : LayerKind::data,
            nullptr};
}

ExrGroup group_of(const ImageLayer& layer) {
    return {&layer.channels, &layer.pixels, layer.kind, &layer};
}

ImagePart whole_of(const OutputImage& image) {
    return image.part_of.value_or(ImagePart{image.width, image.height, 0, 0});
}

ExrRows all_rows(const OutputImage& image) {
    return {0, image.height, 0, whole_of(image).height, ""};
}

/// The rows of each view in its own part; a view that a crop leaves out has none.
std::vector<ExrRows> rows_of_parts(const ExrContent& content) {
    const OutputImage& image = content.image;
    const std::vector<std::string>& views = content.metadata.standard.views;
    if (views.empty() || content.options.layout != ExrLayout::multipart) return {all_rows(image)};
    const ImagePart whole = whole_of(image);
    const int height = whole.height / static_cast<int>(views.size());
    std::vector<ExrRows> out;
    int top = 0;
    for (const std::string& view : views) {
        const int first = std::clamp(top - whole.y, 0, image.height);
        const int end = std::clamp(top + height - whole.y, 0, image.height);
        if (first < end) out.push_back({first, end - first, top, height, view});
        top += height;
    }
    return out;
}

ExrPart make_part(const std::string& layer,
                  std::vector<ExrGroup> groups,
                  const ExrOptions& options,
                  const ExrRows& rows) {
    const ExrCompression codec = codec_for(groups, options.compression);
    const std::string name = rows.view.empty() ? layer : layer + "-" + rows.view;
    return {name, std::move(groups), codec, rows};
}

/// A name that is the end of a file's name and part of an attribute's.
bool is_name(const std::string& name) {
    return !name.empty() && std::none_of(name.begin(), name.end(), [](char c) {
        return static_cast<unsigned char>(c) < ' ' || c == '/' || c == '\\' || c == '\x7F';
    });
}

}  // namespace

const char* beauty_part_name(const ImageMetadata& metadata) {
    return metadata.is_color ? "rgba" : "main";
}

std::vector<ExrPart> parts_of_image(const ExrContent& content) {
    const ExrOptions& options = content.options;
    const std::string name = beauty_part_name(content.metadata);
    std::vector<ExrPart> parts;
    for (const ExrRows& rows : rows_of_parts(content)) {
        std::vector<ExrGroup> groups = {beauty_of(content)};
        if (options.layout == ExrLayout::single) {
            for (const ImageLayer& layer : content.image.layers)
                groups.push_back(group_of(layer));
        }
        parts.push_back(make_part(name, std::move(groups), options, rows));
        if (options.layout != ExrLayout::multipart) continue;
        for (const ImageLayer& layer : content.image.layers)
            parts.push_back(make_part(layer.name, {group_of(layer)}, options, rows));
    }
    return parts;
}

ExrPart part_of_layer(const ExrContent& content, const ImageLayer& layer) {
    return make_part(layer.name, {group_of(layer)}, content.options, all_rows(content.image));
}

ExrDepth depth_of(const ExrGroup& group, const ExrPart& part, const ExrOptions& options) {
    if (group.kind != LayerKind::color) return ExrDepth::float32;
    return is_dwa(part.compression) ? ExrDepth::half : options.depth;
}

bool is_averaged(const ExrGroup& group) {
    if (group.kind == LayerKind::id) return false;
    return group.layer == nullptr || group.layer->reduction.empty() ||
           group.layer->reduction == "mean";
}

bool is_lossless_instead(const ExrPart& part, const ExrOptions& options) {
    return has_kind(part.groups, true) && part.compression != options.compression;
}

bool is_half_instead(const ExrPart& part, const ExrOptions& options) {
    return options.depth == ExrDepth::float32 && is_dwa(part.compression) &&
           has_kind(part.groups, true);
}

Result<void> check_layers(const ExrContent& content, const std::string& where) {
    const auto refuse = [&](const std::string& message) {
        return fail(ExitCode::usage, "E-OUT-LAYER", where, message);
    };
    std::set<std::string> names = {beauty_part_name(content.metadata)};
    std::set<std::string> channels(content.image.channels.begin(), content.image.channels.end());
    for (const ImageLayer& layer : content.image.layers) {
        if (!is_name(layer.name)) {
            return refuse("'" + layer.name + "' is no name for a layer; expected letters, digits " +
                          "and signs other than / and \\");
        }
        if (!names.insert(layer.name).second) {
            return refuse("two layers are called '" + layer.name + "'; expected different names");
        }
        for (const std::string& channel : layer.channels) {
            if (!channel.empty() && channels.insert(channel).second) continue;
            return refuse("layer '" + layer.name + "' has a channel '" + channel +
                          "' that another one has, or that has no name; expected names like " +
                          layer.name + ".R");
        }
    }
    return {};
}

}  // namespace obscura
