// image/encode_display.cpp - encodes finished images for displays, with what their colours mean.
// SPDX-License-Identifier: Apache-2.0
#include "base/log.h"
#include "image/encode.h"
#include "image/fingerprint.h"
#include "image/icc_profile.h"
#include "image/oiio.h"

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

/// What a header says: the texts of a PNG, or attributes by OpenImageIO's names.
std::vector<std::pair<std::string, std::string>> attributes_of(const Encodable& image) {
    std::vector<std::pair<std::string, std::string>> out;
    const auto add = [&](const char* name, const std::string& text) {
        if (!text.empty())
            out.emplace_back(name, escape_control(text));  // none may be empty in IPTC
    };
    add("Software", image.metadata.software);
    add("Copyright", image.metadata.copyright);
    const OutputFormat format = image.target.format;
    const std::string fingerprint = fingerprint_of(image.metadata);
    const std::string name(fingerprint_name);
    if (format == OutputFormat::png) {
        add(name.c_str(), fingerprint);
    } else if (!fingerprint.empty()) {
        add("ImageDescription", name + "=" + fingerprint);
    }
    if (format == OutputFormat::tiff) {
        add("compression", "zip");
        out.emplace_back("DateTime", "");  // else the time of writing: no two files would be equal
    }
    if (format == OutputFormat::jpeg) {
        add("compression", "jpeg:" + std::to_string(image.quality));
        add("jpeg:subsampling", "4:4:4");
    }
    return out;
}

/// JPEG and TIFF.
Result<std::vector<std::byte>> encode_with_oiio(const Encodable& image) {
    const Result<const OiioModule*>& oiio = oiio_module();
    if (!oiio) return fail(oiio.error());
    const OutputFormat format = image.target.format;
    const std::vector<std::byte> profile =
        image.is_srgb() ? srgb_icc_profile() : std::vector<std::byte>();
    const OiioImage whole{.width = image.width,
                          .height = image.height,
                          .channels = image.channels,
                          .type = image.bits == 16 ? OiioType::uint16 : OiioType::uint8,
                          .codes = image.codes,
                          .attributes = attributes_of(image),
                          .icc_profile = profile};
    std::vector<std::byte> encoded;
    const std::string failure = (*oiio)->encode(entry_of(format).name, whole, encoded);
    if (!failure.empty()) {
        return fail(
            ExitCode::internal, "E-OUT-ENCODE", image.target.name, "encoding failed: " + failure);
    }
    return encoded;
}

/// PNG, which has 16 bits, JPEG and TIFF.
Result<std::vector<std::byte>> encode_with_texts(const Encodable& image) {
    if (image.target.format != OutputFormat::png) return encode_with_oiio(image);
    return encode_png({.width = image.width,
                       .height = image.height,
                       .channels = image.channels,
                       .bits = image.bits,
                       .codes = image.codes,
                       .code_points = image.code_points,
                       .texts = attributes_of(image)},
                      image.target.name);
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
        return encode_with_texts(encodable);
    }
    std::vector<uint8_t> codes = display_codes<uint8_t>(image, format.has_alpha, how);
    const bool has_texts =
        target.format != OutputFormat::avif && target.format != OutputFormat::webp;
    if (!has_texts && codes.size() == pixels) codes = spread_grey(codes);
    encodable.channels = static_cast<int>(codes.size() / pixels);
    encodable.codes = codes.data();
    if (has_texts) return encode_with_texts(encodable);
    const CodedImage coded{image.width, image.height, encodable.channels, codes.data()};
    if (target.format == OutputFormat::avif) {
        return encode_avif(coded, encodable.quality, target.name);
    }
    return encode_webp(coded, encodable.quality, encodable.is_srgb(), metadata, target.name);
}

}  // namespace obscura
