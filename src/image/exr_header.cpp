// image/exr_header.cpp - the headers of OpenEXR files.
// SPDX-License-Identifier: Apache-2.0
#include "base/log.h"
#include "image/exr_parts.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticities.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFramesPerSecond.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <Imath/ImathBox.h>
#include <Imath/ImathMatrix.h>
#include <algorithm>
#include <cstring>
#include <limits>

namespace obscura {

namespace {

/// Inserts a text attribute. Escapes control characters: names from an asset may hold some, which
/// terminals would execute.
void insert_text(Imf::Header& header, const std::string& name, const std::string& text) {
    if (!text.empty()) header.insert(name, Imf::StringAttribute(escape_control(text)));
}

struct InsertValue {
    Imf::Header& header;
    const std::string& name;

    void operator()(const std::string& text) const { insert_text(header, name, text); }
    void operator()(int value) const { header.insert(name, Imf::IntAttribute(value)); }
    void operator()(float value) const { header.insert(name, Imf::FloatAttribute(value)); }
    void operator()(double value) const { header.insert(name, Imf::DoubleAttribute(value)); }
};

Imath::M44f matrix_from(const std::array<float, 16>& values) {
    Imath::M44f matrix;
    std::memcpy(matrix.getValue(), values.data(), sizeof values);
    return matrix;
}

Imf::Header header_of_size(const OutputImage& image, const ExrRows& rows) {
    const Imath::V2i size(image.width, rows.count);
    const ImagePart part = image.part_of.value_or(ImagePart{image.width, image.height, 0, 0});
    const Imath::V2i low(part.x, part.y + rows.first - rows.top);
    return {{{0, 0}, {part.width - 1, rows.height - 1}}, {low, low + size - Imath::V2i(1)}};
}

void insert_camera(Imf::Header& header, const StandardAttributes& standard) {
    if (standard.world_to_camera) {
        Imf::addWorldToCamera(header, matrix_from(*standard.world_to_camera));
    }
    if (standard.world_to_ndc) Imf::addWorldToNDC(header, matrix_from(*standard.world_to_ndc));
    header.screenWindowWidth() = standard.screen_window_width;
    const auto& center = standard.screen_window_center;
    header.screenWindowCenter() = {center[0], center[1]};
    if (standard.fstop) Imf::addAperture(header, *standard.fstop);
    if (standard.exposure_s) Imf::addExpTime(header, *standard.exposure_s);
    if (standard.iso) Imf::addIsoSpeed(header, *standard.iso);
    if (standard.focus_m) Imf::addFocus(header, *standard.focus_m);
    if (standard.is_latlong) Imf::addEnvmap(header, Imf::ENVMAP_LATLONG);
}

void insert_time(Imf::Header& header, const StandardAttributes& standard) {
    if (standard.frame_rate_hz) {
        Imf::addFramesPerSecond(header, Imf::guessExactFps(*standard.frame_rate_hz));
    }
    if (standard.time_code) {
        const TimeCode& time = *standard.time_code;
        Imf::addTimeCode(header, Imf::TimeCode(time.hours, time.minutes, time.seconds, time.frame));
    }
    if (!standard.capture_date.empty()) Imf::addCapDate(header, standard.capture_date);
}

void insert_origin(Imf::Header& header, const ImageMetadata& metadata) {
    // First, so that they cannot replace an attribute below.
    for (const ImageAttribute& attribute : metadata.extra)
        insert_attribute(header, attribute);
    insert_text(header, "Software", metadata.software);
    insert_text(header, "copyright", metadata.copyright);
    insert_text(header, "owner", metadata.copyright);
    insert_text(header, "obscura:asset", metadata.asset);
    header.insert("obscura:samplesPerPixel", Imf::IntAttribute(metadata.samples_per_pixel));
    if (metadata.seed <= static_cast<uint64_t>(std::numeric_limits<int>::max())) {
        header.insert("obscura:seed", Imf::IntAttribute(static_cast<int>(metadata.seed)));
    } else {
        insert_text(header, "obscura:seed", std::to_string(metadata.seed));
    }
}

const char* name_of(LayerKind kind) {
    switch (kind) {
        case LayerKind::color:
            return "color";
        case LayerKind::data:
            return "data";
        case LayerKind::id:
            return "id";
    }
    return "";
}

void insert_own_metadata(Imf::Header& header, const ImageLayer& layer) {
    for (const auto& [name, text] : layer.metadata)
        insert_text(header, name, text);
}

/// A part with several groups names each; otherwise the part is the group.
void insert_group(Imf::Header& header, const ExrGroup& group, bool is_alone) {
    const ImageLayer* const layer = group.layer;
    const bool is_named = layer != nullptr && !is_alone;
    const std::string prefix = is_named ? "obscura:layer:" + layer->name + ":" : "obscura:";
    insert_text(header, prefix + "kind", name_of(group.kind));
    if (layer == nullptr) return;
    insert_text(header, prefix + "expression", layer->expression);
    insert_text(header, prefix + "reduction", layer->reduction);
    insert_own_metadata(header, *layer);
}

Imf::Compression codec_of(ExrCompression compression) {
    static_assert(static_cast<int>(ExrCompression::zip) == Imf::ZIP_COMPRESSION);
    static_assert(static_cast<int>(ExrCompression::dwab) == Imf::DWAB_COMPRESSION);
    return static_cast<Imf::Compression>(compression);  // the same list in the same order
}

void insert_storage(Imf::Header& header, const ExrPart& part, const ExrOptions& options) {
    constexpr int default_tile = 64;
    header.compression() = codec_of(part.compression);
    header.dwaCompressionLevel() = options.dwa_level;
    header.zipCompressionLevel() = 3;  // 4, the default, takes half as long again for 4 % less
    const bool is_tiled = options.tile_size > 0 || options.mipmap;
    header.setType(is_tiled ? Imf::TILEDIMAGE : Imf::SCANLINEIMAGE);
    if (is_tiled) {
        const auto size =
            static_cast<unsigned>(options.tile_size > 0 ? options.tile_size : default_tile);
        header.setTileDescription(
            Imf::TileDescription(size, size, options.mipmap ? Imf::MIPMAP_LEVELS : Imf::ONE_LEVEL));
    }
    for (const ExrGroup& group : part.groups) {
        const Imf::Channel channel(depth_of(group, part, options) == ExrDepth::half ? Imf::HALF
                                                                                    : Imf::FLOAT);
        for (const std::string& name : *group.channels)
            header.channels().insert(name, channel);
    }
}

Imf::Chromaticities chromaticities_of(const RenderingSpace& space) {
    const auto point = [](const Chromaticity& from) {
        return Imath::V2f(static_cast<float>(from.x), static_cast<float>(from.y));
    };
    const RgbPrimaries& rgb = space.primaries;
    return {point(rgb[0]), point(rgb[1]), point(rgb[2]), point(space.white)};
}

bool has_color(const ExrPart& part) {
    return std::any_of(part.groups.begin(), part.groups.end(), [](const ExrGroup& group) {
        return group.kind == LayerKind::color;
    });
}

Imf::Header header_of(const ExrContent& content, const ExrPart& part) {
    const ImageMetadata& metadata = content.metadata;
    Imf::Header header = header_of_size(content.image, part.rows);
    insert_origin(header, metadata);
    for (const ExrGroup& group : part.groups)
        insert_group(header, group, part.groups.size() == 1);
    const bool is_color = part.groups.front().kind == LayerKind::color;
    insert_text(header, "colorInteropID", is_color ? metadata.space.interop_id : "data");
    if (has_color(part)) {
        Imf::addChromaticities(header, chromaticities_of(metadata.space));
        if (metadata.standard.white_luminance) {
            Imf::addWhiteLuminance(header, *metadata.standard.white_luminance);
        }
    }
    insert_camera(header, metadata.standard);
    insert_time(header, metadata.standard);
    if (!part.rows.view.empty()) header.setView(part.rows.view);
    insert_storage(header, part, content.options);
    return header;
}

}  // namespace

void insert_attribute(Imf::Header& header, const ImageAttribute& attribute) {
    std::visit(InsertValue{header, attribute.name}, attribute.value);
}

std::vector<Imf::Header> headers_of(const ExrContent& content, const std::vector<ExrPart>& parts) {
    std::vector<Imf::Header> headers;
    for (const ExrPart& part : parts) {
        headers.push_back(header_of(content, part));
        if (parts.size() > 1) headers.back().setName(part.name);
    }
    // A file's parts share their chromaticities: the first has them if any has.
    if (std::any_of(parts.begin(), parts.end(), has_color)) {
        Imf::addChromaticities(headers.front(), chromaticities_of(content.metadata.space));
    }
    // Programs that read the first header only find there what layers say for themselves.
    for (const ExrPart& part : parts) {
        for (const ExrGroup& group : part.groups) {
            if (group.layer != nullptr) insert_own_metadata(headers.front(), *group.layer);
        }
    }
    return headers;
}

}  // namespace obscura
