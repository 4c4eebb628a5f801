// image/decode.cpp - decodes PNG, JPEG, WebP and KTX2 in memory to straight-alpha RGBA8.
// SPDX-License-Identifier: Apache-2.0
#include "image/decode.h"

#include "image/corrupt.h"
#include "image/image_header.h"
#include "image/ktx2.h"
#include "image/oiio.h"
#include "image/strip_metadata.h"

#include <bit>
#include <cstring>
#include <memory>
#include <new>
#include <webp/decode.h>
#include <webp/demux.h>

namespace obscura {

namespace {

static_assert(std::endian::native == std::endian::little, "texels keep R in the lowest byte");

using ByteSpan = std::span<const std::byte>;

/// Spreads 1 (grey) or 2 (grey, alpha) channels, as read into 4-byte texels, over all four.
void spread_grey(std::vector<uint32_t>& texels, bool has_alpha) {
    for (uint32_t& texel : texels) {
        const uint32_t grey = texel & 0xFF;
        const uint32_t alpha = has_alpha ? texel >> 8 & 0xFF : 0xFF;
        texel = grey | grey << 8 | grey << 16 | alpha << 24;
    }
}

/// Reads 16-bit channels into both planes of an image.
bool read_wide(OiioInput& input, ImageRgba8& image) {
    constexpr uint64_t opaque = uint64_t{0xFFFF} << 48;
    std::vector<uint64_t> wide(image.texels.size(), opaque);
    if (!input.read(OiioType::uint16, wide.data(), sizeof(uint64_t))) return false;
    for (size_t i = 0; i < wide.size(); ++i) {
        uint32_t high = 0, low = 0;
        for (int c = 0; c < 4; ++c) {
            const auto code = static_cast<uint32_t>(wide[i] >> (16 * c) & 0xFFFFU);
            high |= code >> 8 << (8 * c);
            low |= (code & 255U) << (8 * c);
        }
        image.texels[i] = high;
        image.low_bytes[i] = low;
    }
    return true;
}

/// True for messages of truncated or undecodable data, which are errors. Other messages of the JPEG
/// library, such as stray bytes after the pixels, are warnings.
bool means_missing_pixels(const std::string& complaint) {
    const auto says = [&](const char* text) { return complaint.find(text) != std::string::npos; };
    return says("remature end") || (says("Corrupt JPEG data") && !says("xtraneous bytes"));
}

Result<void> decode_with_oiio(
    ByteSpan bytes, ImageFormat format, ImageRgba8& image, const std::string& where, Log& log) {
    const Result<const OiioModule*>& oiio = oiio_module();
    if (!oiio) return fail(oiio.error());
    const std::vector<std::byte> pixels_only = without_metadata(bytes, format);
    const std::unique_ptr<OiioInput> input = (*oiio)->open(pixels_only, image.format.c_str());
    if (!input->error().empty()) return corrupt_image(where, input->error());
    const int channels = input->channels();
    if (input->width() != image.width || input->height() != image.height || channels < 1 ||
        channels > 4) {
        return corrupt_image(where, "the size or the number of channels contradicts the header");
    }
    const bool read = image.low_bytes.empty()
                          ? input->read(OiioType::uint8, image.texels.data(), sizeof(uint32_t))
                          : read_wide(*input, image);
    const std::string complaint = input->errors();
    if (!read || means_missing_pixels(complaint)) {
        return corrupt_image(where, complaint.empty() ? "cut off or broken" : complaint);
    }
    if (!complaint.empty()) log.warn(where, complaint);
    if (channels <= 2) {
        spread_grey(image.texels, channels == 2);
        spread_grey(image.low_bytes, channels == 2);
    }
    return {};
}

Result<void> decode_webp(ByteSpan bytes, ImageRgba8& image, const std::string& where) {
    const auto* out = WebPDecodeRGBAInto(reinterpret_cast<const uint8_t*>(bytes.data()),
                                         bytes.size(),
                                         reinterpret_cast<uint8_t*>(image.texels.data()),
                                         image.texels.size() * sizeof(uint32_t),
                                         image.width * int{sizeof(uint32_t)});
    if (!out) return corrupt_image(where, "the WebP data are cut off or broken");
    return {};
}

Result<void> decode_first_webp_frame(ByteSpan bytes, ImageRgba8& image, const std::string& where) {
    WebPAnimDecoderOptions options;
    if (!WebPAnimDecoderOptionsInit(&options)) return corrupt_image(where, "libwebp does not fit");
    options.color_mode = MODE_RGBA;
    const WebPData data{reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()};
    const std::unique_ptr<WebPAnimDecoder, void (*)(WebPAnimDecoder*)> decoder(
        WebPAnimDecoderNew(&data, &options), WebPAnimDecoderDelete);
    uint8_t* canvas = nullptr;
    int time = 0;
    if (!decoder || !WebPAnimDecoderGetNext(decoder.get(), &canvas, &time)) {
        return corrupt_image(where, "the animated WebP's data are cut off or broken");
    }
    std::memcpy(image.texels.data(), canvas, image.texels.size() * sizeof(uint32_t));
    return {};
}

Result<ImageRgba8> decode_levels(ByteSpan bytes,
                                 Extent extent,
                                 const std::string& where,
                                 Log& log) {
    Result<Ktx2Header> header = read_ktx2_header(bytes, where);
    if (!header) return fail(std::move(header.error()));
    if (extent == Extent::base) header->levels = 1;
    return decode_ktx2(*header, where, log);
}

}  // namespace

Result<ImageRgba8> probe_image(ByteSpan bytes, const std::string& where) {
    const Result<ImageHeader> header = read_image_header(bytes, where);
    if (!header) return fail(header.error());
    return ImageRgba8{header->width,
                      header->height,
                      {},
                      format_name(header->format),
                      header->levels,
                      header->encoding,
                      header->bits};
}

Result<ImageRgba8> decode_image(ByteSpan bytes, const std::string& where, Log& log, Extent extent) {
    const Result<ImageHeader> header = read_image_header(bytes, where);
    if (!header) return fail(header.error());
    ImageRgba8 image{header->width, header->height, {}, format_name(header->format)};
    if (header->animated) log.warn(where, "animated: only its first frame is used");
    try {
        if (header->format == ImageFormat::ktx2) return decode_levels(bytes, extent, where, log);
        const size_t count = static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
        image.texels.assign(count, 0xFF000000U);  // opaque, if the image has no alpha
        image.bits = header->bits;
        if (image.bits == 16 && extent == Extent::stored) image.low_bytes = image.texels;
        Result<void> decoded = header->format != ImageFormat::webp
                                   ? decode_with_oiio(bytes, header->format, image, where, log)
                               : header->animated ? decode_first_webp_frame(bytes, image, where)
                                                  : decode_webp(bytes, image, where);
        if (!decoded) return fail(std::move(decoded.error()));
    } catch (const std::bad_alloc&) {
        return fail(ExitCode::out_of_memory,
                    "E-IMG-MEMORY",
                    where,
                    "no memory for " + std::to_string(image.width) + " x " +
                        std::to_string(image.height) + " pixels");
    } catch (const std::exception& error) {
        return corrupt_image(where, error.what());
    }
    return image;
}

}  // namespace obscura
