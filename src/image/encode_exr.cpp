// image/encode_exr.cpp - encodes finished images as OpenEXR.
// SPDX-License-Identifier: Apache-2.0
#include "image/encode.h"
#include "image/exr_chunks.h"
#include "image/exr_parts.h"
#include "image/exr_pixels.h"
#include "image/exr_stream.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfTiledOutputPart.h>

#include <Imath/ImathBox.h>
#include <algorithm>

namespace obscura {

namespace {

size_t values_of(const OutputImage& image) {
    size_t values = image.pixels.size();
    for (const ImageLayer& layer : image.layers)
        values += layer.pixels.size();
    return values;
}

/// The values of a group's plane at one level of a mipmap.
struct StoredPlane {
    const ExrGroup& group;
    ChannelPlane plane;
    PixelView floats;
    UnsetArray<float> level = {};  ///< what `floats` looks at, below the first level
    UnsetArray<half> halves = {};  ///< reused from rows to rows
};

/// Rows of a plane in memory.
PixelView rows_of(const StoredPlane& stored, int first, int count, int width) {
    const ChannelPlane& plane = stored.plane;
    const size_t before = static_cast<size_t>(first) * static_cast<size_t>(width) * plane.channels;
    return {stored.group.pixels->data() + plane.first_value + before, width, count, plane.channels};
}

/// Adds a plane's channels to what OpenEXR writes, as halves if they are stored so.
///
/// Out     how many values were clamped
uint64_t add_channels(StoredPlane& stored,
                      const Imf::Header& header,
                      const Imath::Box2i& window,
                      Imf::FrameBuffer& buffer) {
    const PixelView& view = stored.floats;
    const auto width = static_cast<size_t>(view.width);
    const size_t count = width * static_cast<size_t>(view.height) * view.channels;
    const std::string& first = stored.group.channels->front();
    const bool is_half = header.channels().findChannel(first)->type == Imf::HALF;
    uint64_t clamped = 0;
    if (is_half) {
        stored.halves.resize(count);
        clamped = store_many_halves({view.pixels, count}, largest_half(header), stored.halves);
    }
    const size_t value_bytes = is_half ? sizeof(half) : sizeof(float);
    const void* data = is_half ? static_cast<const void*>(stored.halves.data())
                               : static_cast<const void*>(view.pixels);
    // OpenEXR's frame buffers serve reading too and are never const; writing does not change them.
    char* base = const_cast<char*>(static_cast<const char*>(data));
    const size_t pixel_bytes = value_bytes * view.channels;
    for (size_t i = 0; i < view.channels; ++i) {
        buffer.insert((*stored.group.channels)[stored.plane.first_channel + i],
                      Imf::Slice::Make(is_half ? Imf::HALF : Imf::FLOAT,
                                       base + i * value_bytes,
                                       window,
                                       pixel_bytes,
                                       pixel_bytes * width));
    }
    return clamped;
}

void shrink(StoredPlane& stored) {
    UnsetArray<float> smaller = half_as_large(stored.floats, is_averaged(stored.group));
    stored.level = std::move(smaller);
    stored.floats = {stored.level.data(),
                     std::max(stored.floats.width / 2, 1),
                     std::max(stored.floats.height / 2, 1),
                     stored.floats.channels};
}

std::vector<StoredPlane> stored_planes(const ExrPart& part, const OutputImage& image) {
    std::vector<StoredPlane> out;
    for (const ExrGroup& group : part.groups) {
        for_planes(group, [&](const ChannelPlane& plane) {
            StoredPlane& stored = out.emplace_back(StoredPlane{group, plane, {}});
            stored.floats = rows_of(stored, part.rows.first, part.rows.count, image.width);
        });
    }
    return out;
}

/// Rows that are made halves at once: a few blocks of the codec for each thread. More would only
/// be more memory to clear.
int rows_at_once(ExrCompression codec, int threads) {
    const int block = codec == ExrCompression::dwab ? 256 : 32;  // at most
    return 2 * block * std::max(threads, 1);
}

/// Writes scan lines.
///
/// Out     how many values were clamped
uint64_t write_lines(Imf::OutputPart out,
                     const ExrPart& part,
                     const ExrContent& content,
                     int threads) {
    std::vector<StoredPlane> planes = stored_planes(part, content.image);
    uint64_t clamped = 0;
    const int step = rows_at_once(part.compression, threads);
    for (int first = 0; first < part.rows.count; first += step) {
        const int count = std::min(step, part.rows.count - first);
        Imath::Box2i window = out.header().dataWindow();
        window.min.y += first;
        window.max.y = window.min.y + count - 1;
        Imf::FrameBuffer buffer;
        for (StoredPlane& stored : planes) {
            stored.floats = rows_of(stored, part.rows.first + first, count, content.image.width);
            clamped += add_channels(stored, out.header(), window, buffer);
        }
        out.setFrameBuffer(buffer);
        out.writePixels(count);
    }
    return clamped;
}

/// Writes tiles, level after level.
///
/// Out     how many values of the first level were clamped
uint64_t write_tiles(Imf::TiledOutputPart out, const ExrPart& part, const ExrContent& content) {
    std::vector<StoredPlane> planes = stored_planes(part, content.image);
    uint64_t clamped = 0;
    for (int level = 0; level < out.numLevels(); ++level) {
        Imf::FrameBuffer buffer;
        for (StoredPlane& stored : planes) {
            if (level > 0) shrink(stored);
            const uint64_t here =
                add_channels(stored, out.header(), out.dataWindowForLevel(level), buffer);
            if (level == 0) clamped += here;
        }
        out.setFrameBuffer(buffer);
        out.writeTiles(0, out.numXTiles(level) - 1, 0, out.numYTiles(level) - 1, level);
    }
    return clamped;
}

EncodedFile encode_parts(const ExrContent& content,
                         const std::vector<ExrPart>& parts,
                         const std::string& name) {
    const std::vector<Imf::Header> headers = headers_of(content, parts);
    const bool all_zip = std::all_of(headers.begin(), headers.end(), is_zip_lines);
    const int threads = all_zip ? 0 : compression_threads(values_of(content.image));
    EncodedFile out;
    for (const ExrPart& part : parts) {
        out.report.lossless_instead |= is_lossless_instead(part, content.options);
        out.report.half_instead |= is_half_instead(part, content.options);
    }
    for (const Imf::Header& header : headers)
        out.report.largest_half = std::min(out.report.largest_half, largest_half(header));
    ExrMemoryWriter stream(name.c_str());
    uint64_t after_headers = 0;
    {
        Imf::MultiPartOutputFile file(
            stream, headers.data(), static_cast<int>(headers.size()), false, threads);
        after_headers = stream.tellp();
        for (size_t i = 0; i < parts.size() && !all_zip; ++i) {
            const int index = static_cast<int>(i);
            out.report.clamped_values +=
                headers[i].type() == Imf::TILEDIMAGE
                    ? write_tiles(Imf::TiledOutputPart(file, index), parts[i], content)
                    : write_lines(Imf::OutputPart(file, index), parts[i], content, threads);
        }
    }  // writes the tables of offsets, but of parts that nobody has begun leaves their room
    if (all_zip) {
        stream.seekp(after_headers);
        out.report.clamped_values = write_zip_chunks(stream, parts, headers);
    }
    out.bytes = stream.take();
    return out;
}

}  // namespace

EncodedFile encode_exr(const OutputImage& image,
                       const ImageMetadata& metadata,
                       const ExrOptions& options,
                       const std::string& name) {
    const ExrContent content{image, metadata, options};
    return encode_parts(content, parts_of_image(content), name);
}

EncodedFile encode_exr_layer(const OutputImage& image,
                             const ImageLayer& layer,
                             const ImageMetadata& metadata,
                             const ExrOptions& options,
                             const std::string& name) {
    const ExrContent content{image, metadata, options};
    return encode_parts(content, {part_of_layer(content, layer)}, name);
}

}  // namespace obscura
