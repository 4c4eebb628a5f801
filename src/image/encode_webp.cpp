// image/encode_webp.cpp - encodes finished images as WebP, with straight alpha.
// SPDX-License-Identifier: Apache-2.0
#include "image/encode.h"
#include "image/icc_profile.h"

#include <memory>
#include <webp/encode.h>
#include <webp/mux.h>

namespace obscura {

namespace {

tl::unexpected<Error> webp_error(const std::string& where, const std::string& message) {
    return fail(ExitCode::internal, "E-OUT-ENCODE", where, "libwebp: " + message);
}

/// A file in libwebp's memory, freed in the end.
struct WebpData {
    WebPData data = {};

    WebpData() = default;
    WebpData(const WebpData&) = delete;
    WebpData& operator=(const WebpData&) = delete;
    ~WebpData() { WebPDataClear(&data); }

    std::vector<std::byte> copy() const {
        const auto* begin = reinterpret_cast<const std::byte*>(data.bytes);
        return std::vector<std::byte>(begin, begin + data.size);
    }
};

/// Bytes that libwebp allocates at `out`; 0: it failed.
size_t encode(const CodedImage& image, int quality, uint8_t** out) {
    const int stride = image.width * image.channels;
    const auto loss = static_cast<float>(quality);
    if (image.channels == 4) {
        return quality == 100
                   ? WebPEncodeLosslessRGBA(image.codes, image.width, image.height, stride, out)
                   : WebPEncodeRGBA(image.codes, image.width, image.height, stride, loss, out);
    }
    return quality == 100
               ? WebPEncodeLosslessRGB(image.codes, image.width, image.height, stride, out)
               : WebPEncodeRGB(image.codes, image.width, image.height, stride, loss, out);
}

Result<std::vector<std::byte>> with_profile(const WebPData& file, const std::string& where) {
    const std::unique_ptr<WebPMux, void (*)(WebPMux*)> mux(WebPMuxCreate(&file, 1), WebPMuxDelete);
    if (!mux) return webp_error(where, "the encoded file cannot be taken apart");
    const std::vector<std::byte> profile = srgb_icc_profile();
    const WebPData chunk{reinterpret_cast<const uint8_t*>(profile.data()), profile.size()};
    WebpData assembled;
    const bool done = WebPMuxSetChunk(mux.get(), "ICCP", &chunk, 0) == WEBP_MUX_OK &&
                      WebPMuxAssemble(mux.get(), &assembled.data) == WEBP_MUX_OK;
    if (!done) return webp_error(where, "the colour profile cannot be added");
    return assembled.copy();
}

}  // namespace

Result<std::vector<std::byte>> encode_webp(const CodedImage& image,
                                           int quality,
                                           bool is_srgb,
                                           const std::string& where) {
    WebpData file;
    uint8_t* bytes = nullptr;
    file.data.size = encode(image, quality, &bytes);
    file.data.bytes = bytes;
    if (file.data.size == 0) return webp_error(where, "encoding failed; memory may be short");
    if (is_srgb) return with_profile(file.data, where);
    return file.copy();
}

}  // namespace obscura
