// image/encode_exr.cpp - encodes finished images as OpenEXR.
// SPDX-License-Identifier: Apache-2.0
#include "base/log.h"
#include "base/parallel.h"
#include "image/encode.h"
#include "image/exr_stream.h"
#include "image/process_settings.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticities.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>

#include <Imath/ImathBox.h>
#include <Imath/ImathMatrix.h>
#include <Imath/half.h>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>

namespace obscura {

namespace {

Imath::M44f matrix_from(const float values[16]) {
    Imath::M44f matrix;
    std::memcpy(matrix.getValue(), values, 16 * sizeof(float));
    return matrix;
}

/// Inserts a text attribute. Escapes control characters: names from an asset may hold some, which
/// terminals would execute.
void insert_text(Imf::Header& header, const std::string& name, const std::string& text) {
    if (!text.empty()) header.insert(name, Imf::StringAttribute(escape_control(text)));
}

/// The data window: the position of the pixels in the image that they are a part of.
Imath::Box2i data_window(const OutputImage& image) {
    const Imath::V2i low =
        image.part_of ? Imath::V2i(image.part_of->x, image.part_of->y) : Imath::V2i(0, 0);
    return {low, low + Imath::V2i(image.width - 1, image.height - 1)};
}

Imf::Header header_of_size(const OutputImage& image) {
    const Imath::Box2i data = data_window(image);
    if (!image.part_of) return {data, data};
    return {{{0, 0}, {image.part_of->width - 1, image.part_of->height - 1}}, data};
}

Imf::Header header_of(const OutputImage& image, const ImageMetadata& metadata, ExrDepth depth) {
    Imf::Header header = header_of_size(image);
    header.compression() = Imf::ZIP_COMPRESSION;
    const Imf::PixelType type = depth == ExrDepth::half ? Imf::HALF : Imf::FLOAT;
    for (const std::string& name : image.channels) {
        header.channels().insert(name, Imf::Channel(type));
    }
    // First, so that they cannot replace an attribute below.
    for (const auto& [name, text] : metadata.extra)
        insert_text(header, name, text);
    if (metadata.is_color) Imf::addChromaticities(header, Imf::Chromaticities());  // Rec.709
    insert_text(header, "colorInteropID", metadata.is_color ? "lin_rec709_scene" : "data");
    Imf::addWorldToCamera(header, matrix_from(metadata.world_to_camera));
    if (metadata.has_ndc) Imf::addWorldToNDC(header, matrix_from(metadata.world_to_ndc));
    insert_text(header, "Software", metadata.software);
    insert_text(header, "asset", metadata.asset);
    insert_text(header, "copyright", metadata.copyright);
    insert_text(header, "seed", std::to_string(metadata.seed));
    header.insert("samplesPerPixel", Imf::IntAttribute(metadata.samples_per_pixel));
    header.insert("renderSeconds",
                  Imf::FloatAttribute(static_cast<float>(metadata.render_seconds)));
    return header;
}

std::vector<half> halves_of(std::span<const float> values) {
    constexpr float largest = 65504;
    constexpr size_t grain = 1 << 16;
    std::vector<half> halves(values.size());
    parallel_ranges(values.size(), grain, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            const float value = values[i];
            halves[i] = half(std::isnan(value) ? 0.0f : std::clamp(value, -largest, largest));
        }
    });
    return halves;
}

/// Large images are compressed on OpenEXR's threads; for small ones starting them does not pay.
int compression_threads(const OutputImage& image) {
    constexpr size_t large = 1 << 20;
    constexpr size_t max_threads = 16;
    if (image.pixels.size() < large) return 0;
    const int threads = static_cast<int>(std::min(max_thread_index(), max_threads));
    if (owns_process_settings() && Imf::globalThreadCount() < threads) {
        Imf::setGlobalThreadCount(threads);
    }
    return std::min(threads, Imf::globalThreadCount());
}

}  // namespace

std::vector<std::byte> encode_exr(const OutputImage& image,
                                  const ImageMetadata& metadata,
                                  ExrDepth depth,
                                  const std::string& name) {
    const bool is_half = depth == ExrDepth::half;
    const std::vector<half> halves = is_half ? halves_of(image.pixels) : std::vector<half>();
    const size_t value_bytes = is_half ? sizeof(half) : sizeof(float);
    const size_t pixel_bytes = value_bytes * image.channels.size();
    const void* data = is_half ? static_cast<const void*>(halves.data())
                               : static_cast<const void*>(image.pixels.data());
    // OpenEXR's frame buffers serve reading too and are never const; writing does not change them.
    char* base = const_cast<char*>(static_cast<const char*>(data));
    Imf::FrameBuffer buffer;
    for (size_t i = 0; i < image.channels.size(); ++i) {
        buffer.insert(image.channels[i],
                      Imf::Slice::Make(is_half ? Imf::HALF : Imf::FLOAT,
                                       base + i * value_bytes,
                                       data_window(image),
                                       pixel_bytes,
                                       pixel_bytes * static_cast<size_t>(image.width)));
    }
    ExrMemoryWriter stream(name.c_str());
    {
        Imf::OutputFile file(stream, header_of(image, metadata, depth), compression_threads(image));
        file.setFrameBuffer(buffer);
        file.writePixels(image.height);
    }  // the table of offsets is written here
    return stream.take();
}

}  // namespace obscura
