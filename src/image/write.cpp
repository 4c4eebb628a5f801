// image/write.cpp - writes finished images: EXR scene-linear, PNG and JPEG through a display.
// SPDX-License-Identifier: Apache-2.0
#include "image/write.h"

#include "base/atomic_file.h"
#include "image/encode.h"

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

Result<void> check_image(const std::filesystem::path& file, const OutputImage& image) {
    const bool is_sound = image.width > 0 && image.height > 0 && !image.channels.empty() &&
                          image.pixels.size() == static_cast<size_t>(image.width) *
                                                     static_cast<size_t>(image.height) *
                                                     image.channels.size();
    if (!is_sound) {
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

Result<std::vector<std::byte>> encode(const std::filesystem::path& file,
                                      const OutputImage& image,
                                      const ImageMetadata& metadata,
                                      ExrDepth depth,
                                      const DisplayTransform* display) {
    try {
        const FileFormat format = format_of(file);
        if (format == FileFormat::exr) {
            return encode_exr(image, metadata, depth, file.string());
        }
        return encode_for_display(
            image.part_of ? whole_image(image) : image,
            metadata,
            format == FileFormat::png ? DisplayFormat::png : DisplayFormat::jpeg,
            display,
            file.string());
    } catch (const std::bad_alloc&) {
        return fail(ExitCode::out_of_memory,
                    "E-OUT-MEMORY",
                    file.string(),
                    "no memory to encode the picture");
    } catch (const std::exception& error) {
        return fail(ExitCode::internal, "E-OUT-ENCODE", file.string(), error.what());
    }
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

Result<void> write_image_file(const std::filesystem::path& file,
                              const OutputImage& image,
                              const ImageMetadata& metadata,
                              ExrDepth depth,
                              const DisplayTransform* display) {
    if (auto known = check_format(file); !known) return known;
    if (auto sound = check_image(file, image); !sound) return sound;
    const Result<std::vector<std::byte>> bytes = encode(file, image, metadata, depth, display);
    if (!bytes) return fail(bytes.error());
    return write_file_atomically(file, *bytes);
}

Result<void> check_output(const std::filesystem::path& file) {
    if (auto known = check_format(file); !known) return known;
    return check_file_can_be_written(file);
}

}  // namespace obscura
