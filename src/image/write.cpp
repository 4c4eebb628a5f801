// image/write.cpp - writes finished images: EXR scene-linear, the others through a display.
// SPDX-License-Identifier: Apache-2.0
#include "image/write.h"

#include "base/atomic_file.h"
#include "base/setting_names.h"
#include "image/encode.h"

#include <algorithm>
#include <new>

namespace obscura {

namespace {

tl::unexpected<Error> bad_format(const std::string& where, std::string message) {
    return fail(ExitCode::usage, "E-OUT-FORMAT", where, std::move(message));
}

Result<OutputTarget> target_of(const std::filesystem::path& file) {
    if (const auto format = output_format_of(file)) return OutputTarget{*format, file.string()};
    const std::string extension = file.extension().string();
    return bad_format(file.string(),
                      (extension.empty() ? "the name has no extension"
                                         : "'" + extension + "' is not a format that is written") +
                          "; accepted are " + output_endings());
}

Result<void> check_image(const OutputTarget& target, const OutputImage& image) {
    const bool is_sound = image.width > 0 && image.height > 0 && !image.channels.empty() &&
                          image.pixels.size() == static_cast<size_t>(image.width) *
                                                     static_cast<size_t>(image.height) *
                                                     image.channels.size();
    if (!is_sound) {
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

}  // namespace

OutputImage whole_image(const OutputImage& image) {
    if (!image.part_of) return image;
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

Result<std::vector<std::byte>> encode_image(const OutputTarget& target,
                                            const OutputImage& image,
                                            const ImageMetadata& metadata,
                                            ExrDepth depth,
                                            const DisplayEncoding& encoding) {
    if (auto sound = check_image(target, image); !sound) return fail(sound.error());
    const int width = image.part_of ? image.part_of->width : image.width;
    const int height = image.part_of ? image.part_of->height : image.height;
    if (auto fits = check_encoding(target, encoding, width, height); !fits) {
        return fail(fits.error());
    }
    try {
        if (target.format == OutputFormat::exr) {
            return encode_exr(image, metadata, depth, target.name);
        }
        if (image.part_of) {
            return encode_for_display(target, whole_image(image), metadata, encoding);
        }
        return encode_for_display(target, image, metadata, encoding);
    } catch (const std::bad_alloc&) {
        return fail(
            ExitCode::out_of_memory, "E-OUT-MEMORY", target.name, "no memory to encode the image");
    } catch (const std::exception& error) {
        return fail(ExitCode::internal, "E-OUT-ENCODE", target.name, error.what());
    }
}

Result<void> write_image_file(const std::filesystem::path& file,
                              const OutputImage& image,
                              const ImageMetadata& metadata,
                              ExrDepth depth,
                              const DisplayEncoding& encoding) {
    const Result<OutputTarget> target = target_of(file);
    if (!target) return fail(target.error());
    const Result<std::vector<std::byte>> bytes =
        encode_image(*target, image, metadata, depth, encoding);
    if (!bytes) return fail(bytes.error());
    return write_file_atomically(file, *bytes);
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
    if (target.format == OutputFormat::avif && !can_write_avif()) {
        return bad_format(target.name,
                          "the OpenImageIO of this build writes no AVIF; write .webp or .png");
    }
    return {};
}

Result<OutputTarget> check_output(const std::filesystem::path& file) {
    Result<OutputTarget> target = target_of(file);
    if (!target) return target;
    if (auto writable = check_file_can_be_written(file); !writable) return fail(writable.error());
    return target;
}

}  // namespace obscura
