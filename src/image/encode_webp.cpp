// image/encode_webp.cpp - encodes finished images as WebP, with straight alpha.
// SPDX-License-Identifier: Apache-2.0
#include "base/xml_text.h"
#include "image/encode.h"
#include "image/fingerprint.h"
#include "image/icc_profile.h"

#include <memory>
#include <span>
#include <string_view>
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

constexpr std::string_view fingerprint_member = "obscura:fingerprint=\"";

/// What the other formats have as texts of their own.
///
/// Source  Adobe, "XMP Specification Part 1": an RDF description with properties as attributes
std::string xmp_packet(const ImageMetadata& metadata) {
    std::string out =
        "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\">"
        "<rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\">"
        "<rdf:Description rdf:about=\"\" xmlns:xmp=\"http://ns.adobe.com/xap/1.0/\" "
        "xmlns:dc=\"http://purl.org/dc/elements/1.1/\" xmlns:obscura=\"urn:obscura\" "
        "xmp:CreatorTool=\"" +
        escape_xml(metadata.software) + "\"";
    const std::string fingerprint = fingerprint_of(metadata);
    if (!fingerprint.empty()) out += " " + std::string(fingerprint_member) + fingerprint + "\"";
    out += ">";
    if (!metadata.copyright.empty()) {
        out += "<dc:rights><rdf:Alt><rdf:li xml:lang=\"x-default\">" +
               escape_xml(metadata.copyright) + "</rdf:li></rdf:Alt></dc:rights>";
    }
    return out + "</rdf:Description></rdf:RDF></x:xmpmeta>";
}

using Mux = std::unique_ptr<WebPMux, void (*)(WebPMux*)>;

bool set_chunk(const Mux& mux, const char* name, std::span<const std::byte> bytes) {
    const WebPData chunk{reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()};
    constexpr int copy = 1;
    return WebPMuxSetChunk(mux.get(), name, &chunk, copy) == WEBP_MUX_OK;
}

Result<std::vector<std::byte>> with_chunks(const WebPData& file,
                                           bool is_srgb,
                                           const ImageMetadata& metadata,
                                           const std::string& where) {
    const Mux mux(WebPMuxCreate(&file, 1), WebPMuxDelete);
    if (!mux) return webp_error(where, "the encoded file cannot be taken apart");
    const std::string xmp = xmp_packet(metadata);
    WebpData assembled;
    const bool done = (!is_srgb || set_chunk(mux, "ICCP", srgb_icc_profile())) &&
                      set_chunk(mux, "XMP ", std::as_bytes(std::span(xmp))) &&
                      WebPMuxAssemble(mux.get(), &assembled.data) == WEBP_MUX_OK;
    if (!done) return webp_error(where, "the colour profile and the texts cannot be added");
    return assembled.copy();
}

}  // namespace

Result<std::vector<std::byte>> encode_webp(const CodedImage& image,
                                           int quality,
                                           bool is_srgb,
                                           const ImageMetadata& metadata,
                                           const std::string& where) {
    WebpData file;
    uint8_t* bytes = nullptr;
    file.data.size = encode(image, quality, &bytes);
    file.data.bytes = bytes;
    if (file.data.size == 0) return webp_error(where, "encoding failed; memory may be short");
    return with_chunks(file.data, is_srgb, metadata, where);
}

std::optional<std::string> fingerprint_of_webp(const std::vector<std::byte>& file) {
    const WebPData data{reinterpret_cast<const uint8_t*>(file.data()), file.size()};
    constexpr int borrow = 0;
    const Mux mux(WebPMuxCreate(&data, borrow), WebPMuxDelete);
    if (!mux) return {};
    WebPData xmp = {};
    if (WebPMuxGetChunk(mux.get(), "XMP ", &xmp) != WEBP_MUX_OK) return "";
    const std::string_view text(reinterpret_cast<const char*>(xmp.bytes), xmp.size);
    const size_t begin = text.find(fingerprint_member);
    if (begin == std::string_view::npos) return "";
    const size_t first = begin + fingerprint_member.size();
    const size_t end = text.find('"', first);
    return std::string(text.substr(first, end == std::string_view::npos ? 0 : end - first));
}

}  // namespace obscura
