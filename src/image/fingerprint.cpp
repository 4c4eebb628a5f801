// image/fingerprint.cpp - the fingerprint of what an image file was made from.
// SPDX-License-Identifier: Apache-2.0
#include "image/fingerprint.h"

#include "base/file_bytes.h"
#include "image/encode.h"
#include "image/oiio.h"
#include "image/output_format.h"

#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <algorithm>
#include <array>
#include <exception>

namespace obscura {

namespace {

/// Throws where a part's last scan lines are not in the file: it has been cut off.
void read_last_chunk(Imf::MultiPartInputFile& input, int number) {
    Imf::InputPart part(input, number);
    const char* bytes = nullptr;
    int size = 0;
    part.rawPixelData(part.header().dataWindow().max.y, bytes, size);
}

/// True when a JPEG has its end: the marker EOI.
bool has_end_of_jpeg(const std::vector<std::byte>& file) {
    constexpr std::array end = {std::byte{0xFF}, std::byte{0xD9}};
    return file.size() >= end.size() && std::equal(end.rbegin(), end.rend(), file.rbegin());
}

/// True when all pixels of a TIFF are there, as is not known before they have been read.
bool has_all_of_tiff(const OiioModule& oiio, const std::vector<std::byte>& file) {
    const std::unique_ptr<OiioInput> input = oiio.open(file, "tiff");
    if (!input->error().empty()) return false;
    const size_t pixels =
        static_cast<size_t>(input->width()) * static_cast<size_t>(input->height());
    const auto channels = static_cast<size_t>(input->channels());
    std::vector<uint8_t> codes(pixels * channels);
    const bool done = input->read(OiioType::uint8, codes.data(), static_cast<ptrdiff_t>(channels));
    return input->errors().empty() && done;
}

std::optional<std::string> fingerprint_of_exr(const std::filesystem::path& file) {
    try {
        Imf::MultiPartInputFile input(file.c_str());
        for (int i = 0; i < input.parts(); ++i)
            read_last_chunk(input, i);
        const std::string name(fingerprint_name);
        const auto* const text = input.header(0).findTypedAttribute<Imf::StringAttribute>(name);
        return text != nullptr ? text->value() : "";
    } catch (const std::exception&) {
        return {};
    }
}

}  // namespace

std::string fingerprint_of(const ImageMetadata& metadata) {
    for (const ImageAttribute& attribute : metadata.extra) {
        const auto* const text = std::get_if<std::string>(&attribute.value);
        if (text != nullptr && attribute.name == fingerprint_name) return *text;
    }
    return "";
}

std::optional<std::string> read_fingerprint(const std::filesystem::path& file) {
    const std::optional<OutputFormat> format = output_format_of(file);
    if (format == OutputFormat::exr) return fingerprint_of_exr(file);
    if (!format || !entry_of(*format).has_texts) return {};
    if (format == OutputFormat::webp) return fingerprint_of_webp(read_file_bytes(file, {}).bytes);
    if (format == OutputFormat::png) return fingerprint_of_png(read_file_bytes(file, {}).bytes);
    if (format == OutputFormat::jpeg && !has_end_of_jpeg(read_file_bytes(file, {}).bytes))
        return {};
    const Result<const OiioModule*>& oiio = oiio_module();
    if (!oiio) return {};
    if (format == OutputFormat::tiff && !has_all_of_tiff(**oiio, read_file_bytes(file, {}).bytes))
        return {};
    const std::array names = {std::string("ImageDescription")};
    const auto texts = (*oiio)->read_texts(entry_of(*format).name, file.string(), names);
    if (!texts) return {};
    const std::string& description = texts->at(0);
    const std::string prefix = std::string(fingerprint_name) + "=";
    return description.starts_with(prefix) ? description.substr(prefix.size()) : "";
}

}  // namespace obscura
