// image/write.cpp - writes finished images: EXR scene-linear, PNG and JPEG through a display.
// SPDX-License-Identifier: Apache-2.0
#include "image/write.h"

#include "base/atomic_file.h"
#include "image/encode.h"
#include "image/exr_parts.h"

#include <algorithm>
#include <new>

namespace obscura {

namespace {

enum class FileFormat { unknown, exr, png, jpeg };

FileFormat format_of(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    for (char& c : extension) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    if (extension == ".exr") return FileFormat::exr;
    if (extension == ".png") return FileFormat::png;
    if (extension == ".jpg" || extension == ".jpeg") return FileFormat::jpeg;
    return FileFormat::unknown;
}

tl::unexpected<Error> bad_format(const std::filesystem::path& file, std::string message) {
    return fail(ExitCode::usage, "E-OUT-FORMAT", file.string(), std::move(message));
}

Result<void> check_format(const std::filesystem::path& file) {
    if (format_of(file) != FileFormat::unknown) return {};
    const std::string extension = file.extension().string();
    return bad_format(file,
                      (extension.empty() ? "the name has no extension"
                                         : "'" + extension + "' is not a format that is written") +
                          "; accepted are .exr, .png, .jpg and .jpeg");
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

Result<void> check_image(const std::filesystem::path& file, const OutputImage& image) {
    if (!has_all_values(image)) {
        return fail(ExitCode::internal,
                    "E-OUT-ENCODE",
                    file.string(),
                    "the picture's size, channels and pixels contradict each other");
    }
    const size_t channels = image.channels.size();
    if (format_of(file) != FileFormat::exr && channels != 1 && channels != 3 && channels != 4) {
        return bad_format(file,
                          "a picture of " + std::to_string(channels) +
                              " channels fits neither PNG nor JPEG (1, 3 or 4); write .exr");
    }
    return {};
}

/// What one file is made of.
struct FileContent {
    const OutputImage& image;
    const ImageLayer* layer;  ///< the only one in the file; null: the image
    const ImageMetadata& metadata;
    const ExrOptions& exr;
    const DisplayTransform* display;
};

Result<EncodedFile> encode_content(const std::filesystem::path& file, const FileContent& content) {
    const FileFormat format = format_of(file);
    if (format == FileFormat::exr) {
        return content.layer != nullptr
                   ? encode_exr_layer(content.image,
                                      *content.layer,
                                      content.metadata,
                                      content.exr,
                                      file.string())
                   : encode_exr(content.image, content.metadata, content.exr, file.string());
    }
    const bool is_part = content.image.part_of.has_value();
    const OutputImage whole = is_part ? whole_image(content.image) : OutputImage{};
    Result<std::vector<std::byte>> bytes =
        encode_for_display(is_part ? whole : content.image,
                           content.metadata,
                           format == FileFormat::png ? DisplayFormat::png : DisplayFormat::jpeg,
                           content.display,
                           file.string());
    if (!bytes) return fail(bytes.error());
    return EncodedFile{std::move(*bytes)};
}

/// Encodes and writes one file, whole or not at all.
Result<WriteReport> write_content(const std::filesystem::path& file, const FileContent& content) {
    Result<EncodedFile> encoded;
    try {
        encoded = encode_content(file, content);
    } catch (const std::bad_alloc&) {
        return fail(ExitCode::out_of_memory,
                    "E-OUT-MEMORY",
                    file.string(),
                    "no memory to encode the picture");
    } catch (const std::exception& error) {
        return fail(ExitCode::internal, "E-OUT-ENCODE", file.string(), error.what());
    }
    if (!encoded) return fail(encoded.error());
    if (auto written = write_file_atomically(file, encoded->bytes); !written) {
        return fail(written.error());
    }
    return encoded->report;
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
    for (size_t y = 0; y < static_cast<size_t>(image.height); ++y) {
        float* const target = whole.pixels.data() + (static_cast<size_t>(part.y) + y) * whole_row +
                              static_cast<size_t>(part.x) * channels;
        std::copy_n(image.pixels.data() + y * row, row, target);
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

Result<WriteReport> write_image_file(const std::filesystem::path& file,
                                     const OutputImage& image,
                                     const ImageMetadata& metadata,
                                     const ExrOptions& exr,
                                     const DisplayTransform* display) {
    if (auto known = check_format(file); !known) return fail(known.error());
    if (auto sound = check_image(file, image); !sound) return fail(sound.error());
    WriteReport all;
    const auto write = [&](const std::filesystem::path& to, const ImageLayer* layer) {
        const auto written = write_content(to, {image, layer, metadata, exr, display});
        if (written) {
            all.clamped_values += written->clamped_values;
            all.lossless_instead |= written->lossless_instead;
        }
        return written;
    };
    if (format_of(file) == FileFormat::exr) {
        const auto fit = check_layers({image, metadata, exr}, file.string());
        if (!fit) return fail(fit.error());
        if (exr.layout == ExrLayout::separate) {
            for (const ImageLayer& layer : image.layers) {
                const auto written = write(layer_file(file, layer.name), &layer);
                if (!written) return written;
            }
        }
    }
    if (const auto written = write(file, nullptr); !written) return written;
    return all;
}

Result<void> check_output(const std::filesystem::path& file) {
    if (auto known = check_format(file); !known) return known;
    return check_file_can_be_written(file);
}

}  // namespace obscura
