// image/fingerprint.cpp - the fingerprint of what an image file was made from.
// SPDX-License-Identifier: Apache-2.0
#include "image/fingerprint.h"

#include "base/file_bytes.h"
#include "image/encode.h"
#include "image/oiio.h"
#include "image/output_format.h"

#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <array>
#include <exception>

namespace obscura {

namespace {

std::optional<std::string> fingerprint_of_exr(const std::filesystem::path& file) {
    try {
        const Imf::MultiPartInputFile input(file.c_str());
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
    const Result<const OiioModule*>& oiio = oiio_module();
    if (!oiio) return {};
    const std::string name(fingerprint_name);
    const std::array names = {name, std::string("ImageDescription")};
    const auto texts = (*oiio)->read_texts(entry_of(*format).name, file.string(), names);
    if (!texts) return {};
    if (!texts->at(0).empty()) return texts->at(0);
    const std::string& description = texts->at(1);
    const std::string prefix = name + "=";
    return description.starts_with(prefix) ? description.substr(prefix.size()) : "";
}

}  // namespace obscura
