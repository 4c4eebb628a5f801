// image/encode_display.cpp - encodes finished images as PNG and JPEG.
// SPDX-License-Identifier: Apache-2.0
#include "base/log.h"
#include "base/parallel.h"
#include "image/encode.h"
#include "image/oiio_input.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>

namespace obscura {

namespace {

unsigned char code_of(float value) {
    const float in_range = std::isnan(value) ? 0.0f : std::clamp(value, 0.0f, 1.0f);
    return static_cast<unsigned char>(std::lround(in_range * 255.0f));
}

/// Divides colour by alpha; colour becomes 0 if alpha is 0.
void unpremultiply(float* rgb, float alpha) {
    const float scale = alpha > 0 ? 1.0f / alpha : 0.0f;
    for (int i = 0; i < 3; ++i)
        rgb[i] *= scale;
}

}  // namespace

std::vector<unsigned char> display_codes(const OutputImage& image,
                                         bool keep_alpha,
                                         const DisplayTransform* display) {
    constexpr size_t grain = 4096;
    const size_t channels = image.channels.size();
    const size_t colors = channels >= 3 ? 3 : 1;
    const bool has_alpha = keep_alpha && channels == 4;
    const size_t out_channels = colors + (has_alpha ? 1 : 0);
    const size_t count = image.pixels.size() / channels;
    std::vector<unsigned char> codes(count * out_channels);
    parallel_ranges(count, grain, [&](size_t begin, size_t end) {
        std::vector<float> rgb((end - begin) * colors);
        for (size_t i = begin; i < end; ++i) {
            const float* pixel = image.pixels.data() + i * channels;
            float* color = rgb.data() + (i - begin) * colors;
            std::copy_n(pixel, colors, color);
            if (has_alpha) unpremultiply(color, std::min(pixel[3], 1.0f));
        }
        if (display && colors == 3) display->apply(rgb.data(), end - begin);
        for (size_t i = begin; i < end; ++i) {
            unsigned char* out = codes.data() + i * out_channels;
            const float* color = rgb.data() + (i - begin) * colors;
            std::transform(color, color + colors, out, code_of);
            if (has_alpha) out[3] = code_of(image.pixels[i * channels + 3]);
        }
    });
    return codes;
}

Result<std::vector<std::byte>> encode_for_display(const OutputImage& image,
                                                  const ImageMetadata& metadata,
                                                  DisplayFormat format,
                                                  const DisplayTransform* display,
                                                  const std::string& where) {
    const bool is_png = format == DisplayFormat::png;
    const std::vector<unsigned char> codes =
        display_codes(image, is_png, metadata.is_color ? display : nullptr);
    prepare_oiio();
    const size_t pixels = image.pixels.size() / image.channels.size();
    const int channels = static_cast<int>(codes.size() / pixels);
    OIIO::ImageSpec spec(image.width, image.height, channels, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    spec.attribute("Software", escape_control(metadata.software));
    if (!metadata.copyright.empty()) {
        spec.attribute("Copyright", escape_control(metadata.copyright));
    }
    spec.attribute("compression", is_png ? "zip:4" : "jpeg:95");
    if (!is_png) spec.attribute("jpeg:subsampling", "4:4:4");
    std::vector<unsigned char> encoded;
    OIIO::Filesystem::IOVecOutput stream(encoded);
    const auto output = OIIO::ImageOutput::create(is_png ? "png" : "jpeg");
    if (output) output->threads(1);
    const bool done = output && output->set_ioproxy(&stream) && output->open(where, spec) &&
                      output->write_image(OIIO::TypeDesc::UINT8, codes.data()) && output->close();
    if (!done) {
        return fail(ExitCode::internal,
                    "E-OUT-ENCODE",
                    where,
                    "encoding failed: " + (output ? output->geterror() : OIIO::geterror()));
    }
    const auto bytes = std::as_bytes(std::span(encoded));
    return std::vector<std::byte>(bytes.begin(), bytes.end());
}

}  // namespace obscura
