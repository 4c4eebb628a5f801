// image/fingerprint.cpp - the fingerprint of what an image file was made from.
// SPDX-License-Identifier: Apache-2.0
#include "image/fingerprint.h"

#include "image/oiio_input.h"
#include "image/output_format.h"

#include <OpenImageIO/imageio.h>

namespace obscura {

namespace {

const char* reader_of(OutputFormat format) {
    switch (format) {
        case OutputFormat::exr:
            return "openexr";
        case OutputFormat::png:
            return "png";
        case OutputFormat::jpeg:
            return "jpeg";
        case OutputFormat::tiff:
            return "tiff";
        case OutputFormat::webp:
        case OutputFormat::avif:
            break;
    }
    return nullptr;
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
    const char* const reader = format ? reader_of(*format) : nullptr;
    if (reader == nullptr) return {};
    prepare_oiio();
    const auto input = OIIO::ImageInput::create(reader);
    OIIO::ImageSpec spec;
    if (!input || !input->open(file.string(), spec)) {
        if (input) input->geterror();  // OpenImageIO prints what nobody takes
        return {};
    }
    const std::string name(fingerprint_name);
    const std::string own(spec.get_string_attribute(name));
    if (!own.empty()) return own;
    const std::string description(spec.get_string_attribute("ImageDescription"));
    const std::string prefix = name + "=";
    return description.starts_with(prefix) ? description.substr(prefix.size()) : "";
}

}  // namespace obscura
