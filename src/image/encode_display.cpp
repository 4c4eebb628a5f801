// image/encode_display.cpp - encodes finished images for displays, with what their colours mean.
// SPDX-License-Identifier: Apache-2.0
#include "base/log.h"
#include "image/encode.h"
#include "image/fingerprint.h"
#include "image/icc_profile.h"
#include "image/oiio_input.h"
#include "image/png_chunks.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>

namespace obscura {

namespace {

/// The codes of an image, with what is to be said about them.
struct Encodable {
    const OutputTarget& target;
    const ImageMetadata& metadata;
    int width, height, channels;
    int bits;
    int quality;
    std::optional<ColorCodePoints> code_points;
    const void* codes;

    bool is_srgb() const { return code_points == srgb_code_points; }
};

const char* oiio_name(OutputFormat format) {
    return format == OutputFormat::png ? "png" : format == OutputFormat::jpeg ? "jpeg" : "tiff";
}

void add_fingerprint(OutputFormat format, const std::string& fingerprint, OIIO::ImageSpec& spec) {
    if (fingerprint.empty()) return;
    const std::string name(fingerprint_name);
    if (format == OutputFormat::png) {
        spec.attribute(name, fingerprint);
    } else {
        spec.attribute("ImageDescription", name + "=" + fingerprint);
    }
}

OIIO::ImageSpec spec_of(const Encodable& image) {
    const OIIO::TypeDesc type = image.bits == 16 ? OIIO::TypeDesc::UINT16 : OIIO::TypeDesc::UINT8;
    OIIO::ImageSpec spec(image.width, image.height, image.channels, type);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    const auto add = [&](const char* name, const std::string& text) {
        if (!text.empty()) spec.attribute(name, escape_control(text));  // none may be empty in IPTC
    };
    add("Software", image.metadata.software);
    add("Copyright", image.metadata.copyright);
    const OutputFormat format = image.target.format;
    add_fingerprint(format, fingerprint_of(image.metadata), spec);
    if (format == OutputFormat::png) spec.attribute("compression", "zip:4");
    if (format == OutputFormat::tiff) {
        spec.attribute("compression", "zip");
        spec.attribute("DateTime", "");  // else the time of writing: no two files would be equal
    }
    if (format == OutputFormat::jpeg) {
        spec.attribute("compression", "jpeg:" + std::to_string(image.quality));
        spec.attribute("jpeg:subsampling", "4:4:4");
    }
    if (format != OutputFormat::png && image.is_srgb()) {  // a PNG has a chunk for that
        const std::vector<std::byte> profile = srgb_icc_profile();
        const OIIO::TypeDesc bytes(OIIO::TypeDesc::UINT8, static_cast<int>(profile.size()));
        spec.attribute("ICCProfile", bytes, profile.data());
    }
    return spec;
}

/// PNG, JPEG and TIFF.
Result<std::vector<std::byte>> encode_with_oiio(const Encodable& image) {
    prepare_oiio();
    const OIIO::ImageSpec spec = spec_of(image);
    std::vector<unsigned char> encoded;
    OIIO::Filesystem::IOVecOutput stream(encoded);
    const auto output = OIIO::ImageOutput::create(oiio_name(image.target.format));
    if (output) output->threads(1);
    const bool done = output && output->set_ioproxy(&stream) &&
                      output->open(image.target.name, spec) &&
                      output->write_image(spec.format, image.codes) && output->close();
    if (!done) {
        return fail(ExitCode::internal,
                    "E-OUT-ENCODE",
                    image.target.name,
                    "encoding failed: " + (output ? output->geterror() : OIIO::geterror()));
    }
    const auto bytes = std::as_bytes(std::span(encoded));
    if (image.target.format == OutputFormat::png) {
        return with_color_chunk(bytes, image.code_points);
    }
    return std::vector<std::byte>(bytes.begin(), bytes.end());
}

/// Grey as RGB, which all that libwebp and libheif take has.
std::vector<uint8_t> spread_grey(const std::vector<uint8_t>& grey) {
    std::vector<uint8_t> rgb;
    rgb.reserve(3 * grey.size());
    for (const uint8_t code : grey)
        rgb.insert(rgb.end(), 3, code);
    return rgb;
}

}  // namespace

Result<std::vector<std::byte>> encode_for_display(const OutputTarget& target,
                                                  const OutputImage& image,
                                                  const ImageMetadata& metadata,
                                                  const DisplayEncoding& encoding) {
    const OutputFormatEntry& format = entry_of(target.format);
    DisplayEncoding how = encoding;
    if (!metadata.is_color) how.transform = nullptr;
    Encodable encodable{.target = target,
                        .metadata = metadata,
                        .width = image.width,
                        .height = image.height,
                        .channels = 0,
                        .bits = how.bits,
                        .quality = how.quality.value_or(format.quality),
                        .code_points = {},
                        .codes = nullptr};
    if (how.transform && image.channels.size() >= 3) {
        encodable.code_points = how.transform->code_points();
    }
    const size_t pixels = image.pixels.size() / image.channels.size();
    if (how.bits == 16) {
        const std::vector<uint16_t> codes = display_codes<uint16_t>(image, format.has_alpha, how);
        encodable.channels = static_cast<int>(codes.size() / pixels);
        encodable.codes = codes.data();
        return encode_with_oiio(encodable);
    }
    std::vector<uint8_t> codes = display_codes<uint8_t>(image, format.has_alpha, how);
    const bool by_oiio = target.format != OutputFormat::webp && target.format != OutputFormat::avif;
    if (!by_oiio && codes.size() == pixels) codes = spread_grey(codes);
    encodable.channels = static_cast<int>(codes.size() / pixels);
    encodable.codes = codes.data();
    if (by_oiio) return encode_with_oiio(encodable);
    const CodedImage coded{image.width, image.height, encodable.channels, codes.data()};
    if (target.format == OutputFormat::avif) {
        return encode_avif(coded, encodable.quality, target.name);
    }
    return encode_webp(coded, encodable.quality, encodable.is_srgb(), target.name);
}

}  // namespace obscura
