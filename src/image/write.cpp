// image/write.cpp - writes finished images: EXR scene-linear, the others through a display.
// SPDX-License-Identifier: Apache-2.0
#include "image/write.h"

#include "base/atomic_file.h"
#include "base/setting_names.h"
#include "image/encode.h"
#include "image/exr_parts.h"
#include "image/oiio.h"

#include <algorithm>
#include <new>

namespace obscura {

namespace {

tl::unexpected<Error> bad_format(const std::string& where, std::string message) {
    return fail(ExitCode::usage, "E-OUT-FORMAT", where, std::move(message));
}

/// True when there are as many values as the size and the channels ask for.
bool has_all_values(const OutputImage& image) {
    if (!(image.width > 0 && image.height > 0)) return false;
    const auto count = static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
    const auto fits = [&](const auto& from) {
        return !from.channels.empty() && from.pixels.size() == count * from.channels.size();
    };
    return fits(image) && std::all_of(image.layers.begin(), image.layers.end(), fits);
}

Result<void> check_image(const OutputTarget& target, const OutputImage& image) {
    if (!has_all_values(image)) {
        return fail(ExitCode::internal,
                    "E-OUT-ENCODE",
                    target.name,
                    "the image's size, channels and pixels contradict each other");
    }
    const size_t channels = image.channels.size();
    if (target.format != OutputFormat::exr && channels != 1 && channels != 3 && channels != 4) {
        return bad_format(target.name,
                          "an image of " + std::to_string(channels) +
                              " channels fits no format for displays (1, 3 or 4); write .exr");
    }
    return {};
}

/// What a file, or an image's several, are made of.
struct FileContent {
    const OutputImage& image;
    const ImageMetadata& metadata;
    const ExrOptions& exr;
    const DisplayEncoding& encoding;
};

Result<void> check_content(const OutputTarget& target, const FileContent& content) {
    const OutputImage& image = content.image;
    if (auto sound = check_image(target, image); !sound) return sound;
    const int width = image.part_of ? image.part_of->width : image.width;
    const int height = image.part_of ? image.part_of->height : image.height;
    if (auto fits = check_encoding(target, content.encoding, width, height); !fits) return fits;
    if (target.format != OutputFormat::exr) return {};
    return check_layers({image, content.metadata, content.exr}, target.name);
}

Result<std::vector<std::byte>> encode_whole(const OutputTarget& target,
                                            const FileContent& content) {
    const OutputImage& image = content.image;
    if (image.part_of) {
        return encode_for_display(target, whole_image(image), content.metadata, content.encoding);
    }
    return encode_for_display(target, image, content.metadata, content.encoding);
}

/// Encodes one file.
///
/// In      layer: the only one in the file, an EXR; null: the image
Result<EncodedFile> encode_content(const OutputTarget& target,
                                   const FileContent& content,
                                   const ImageLayer* layer) {
    const auto& [image, metadata, exr, encoding] = content;
    try {
        if (layer) return encode_exr_layer(image, *layer, metadata, exr, target.name);
        if (target.format == OutputFormat::exr) {
            return encode_exr(image, metadata, exr, target.name);
        }
        Result<std::vector<std::byte>> bytes = encode_whole(target, content);
        if (!bytes) return fail(bytes.error());
        return EncodedFile{std::move(*bytes)};
    } catch (const std::bad_alloc&) {
        return fail(
            ExitCode::out_of_memory, "E-OUT-MEMORY", target.name, "no memory to encode the image");
    } catch (const std::exception& error) {
        return fail(ExitCode::internal, "E-OUT-ENCODE", target.name, error.what());
    }
}

}  // namespace

OutputImage whole_image(const OutputImage& image) {
    if (!image.part_of) return {image.width, image.height, image.channels, image.pixels};
    const ImagePart& part = *image.part_of;
    const size_t channels = image.channels.size();
    const size_t row = static_cast<size_t>(image.width) * channels;
    const size_t whole_row = static_cast<size_t>(part.width) * channels;
    OutputImage whole{part.width, part.height, image.channels, {}};
    whole.pixels.resize(whole_row * static_cast<size_t>(part.height));
    std::fill(whole.pixels.begin(), whole.pixels.end(), 0.0f);
    // What lies outside the whole image (overscan) is left out.
    const int left = std::max(part.x, 0);
    const int right = std::min(part.x + image.width, part.width);
    if (left >= right) return whole;
    const size_t count = static_cast<size_t>(right - left) * channels;
    for (int y = std::max(part.y, 0); y < std::min(part.y + image.height, part.height); ++y) {
        const float* const from = image.pixels.data() + static_cast<size_t>(y - part.y) * row +
                                  static_cast<size_t>(left - part.x) * channels;
        float* const target = whole.pixels.data() + static_cast<size_t>(y) * whole_row +
                              static_cast<size_t>(left) * channels;
        std::copy_n(from, count, target);
    }
    return whole;
}

std::filesystem::path layer_file(const std::filesystem::path& beauty, const std::string& layer) {
    const std::string stem = beauty.stem().string();
    const size_t digits = stem.find_last_not_of("0123456789") + 1;
    const bool has_number = digits < stem.size() && digits > 1 && stem[digits - 1] == '.';
    const std::string name =
        has_number ? stem.substr(0, digits) + layer + stem.substr(digits - 1) : stem + "." + layer;
    return beauty.parent_path() / (name + beauty.extension().string());
}

Result<EncodedFile> encode_image(const OutputTarget& target,
                                 const OutputImage& image,
                                 const ImageMetadata& metadata,
                                 const ExrOptions& exr,
                                 const DisplayEncoding& encoding) {
    const FileContent content{image, metadata, exr, encoding};
    if (auto checked = check_content(target, content); !checked) return fail(checked.error());
    return encode_content(target, content, nullptr);
}

Result<WriteReport> write_image_file(const std::filesystem::path& file,
                                     const OutputImage& image,
                                     const ImageMetadata& metadata,
                                     const ExrOptions& exr,
                                     const DisplayEncoding& encoding) {
    const FileToWrite whole{file, [](const auto& path, std::span<const std::byte> bytes) {
                                return write_file_atomically(path, bytes);
                            }};
    return write_image_file(whole, image, metadata, exr, encoding);
}

Result<WriteReport> write_image_file(const FileToWrite& file,
                                     const OutputImage& image,
                                     const ImageMetadata& metadata,
                                     const ExrOptions& exr,
                                     const DisplayEncoding& encoding) {
    const Result<OutputTarget> target = output_target(file.path);
    if (!target) return fail(target.error());
    const FileContent content{image, metadata, exr, encoding};
    if (auto checked = check_content(*target, content); !checked) return fail(checked.error());
    WriteReport all;
    const auto write = [&](const std::filesystem::path& to,
                           const ImageLayer* layer) -> Result<void> {
        const auto encoded = encode_content({target->format, to.string()}, content, layer);
        if (!encoded) return fail(encoded.error());
        all.clamped_values += encoded->report.clamped_values;
        all.lossless_instead |= encoded->report.lossless_instead;
        all.half_instead |= encoded->report.half_instead;
        all.largest_half = std::min(all.largest_half, encoded->report.largest_half);
        return file.write(to, encoded->bytes);
    };
    if (target->format == OutputFormat::exr && exr.layout == ExrLayout::separate) {
        for (const ImageLayer& layer : image.layers) {
            const auto written = write(layer_file(file.path, layer.name), &layer);
            if (!written) return fail(written.error());
        }
    }
    if (const auto written = write(file.path, nullptr); !written) return fail(written.error());
    return all;
}

Result<void> check_encoding(const OutputTarget& target,
                            const DisplayEncoding& encoding,
                            int width,
                            int height) {
    const OutputFormatEntry& format = entry_of(target.format);
    if (encoding.bits > format.max_bits) {
        return fail(ExitCode::usage,
                    "E-USAGE-CONFLICT",
                    setting("bits"),
                    target.name + ": " + format.name + " has " + std::to_string(format.max_bits) +
                        " bits a channel; 16 are for PNG and TIFF, and EXR has 16 or 32 anyway");
    }
    if (std::max(width, height) > format.max_side) {
        return bad_format(target.name,
                          std::to_string(width) + " x " + std::to_string(height) +
                              " pixels are too many for " + format.name + ", whose sides have " +
                              std::to_string(format.max_side) + " at most; write .png or .exr");
    }
    if (target.format != OutputFormat::avif) return {};
    if (auto there = check_writer(target.format); !there) return there;
    if (!can_write_avif()) {
        return bad_format(target.name,
                          "the OpenImageIO of this build writes no AVIF; write .webp or .png");
    }
    return {};
}

Result<void> check_writer(OutputFormat format) {
    if (!is_written_by_oiio(format)) return {};
    const Result<const OiioModule*>& oiio = oiio_module();
    if (!oiio) return fail(oiio.error());
    return {};
}

Result<OutputTarget> output_target(const std::filesystem::path& file) {
    if (const auto format = output_format_of(file)) return OutputTarget{*format, file.string()};
    const std::string extension = file.extension().string();
    return bad_format(file.string(),
                      (extension.empty() ? "the name has no extension"
                                         : "'" + extension + "' is not a format that is written") +
                          "; accepted are " + output_endings());
}

Result<OutputTarget> check_output(const std::filesystem::path& file) {
    Result<OutputTarget> target = output_target(file);
    if (!target) return target;
    if (auto writable = check_file_can_be_written(file); !writable) return fail(writable.error());
    return target;
}

}  // namespace obscura
