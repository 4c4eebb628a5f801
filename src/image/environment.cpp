// image/environment.cpp - reads an environment map from disk as finite linear RGB.
// SPDX-License-Identifier: Apache-2.0
#include "base/file_bytes.h"
#include "base/memory_budget.h"
#include "image/corrupt.h"
#include "image/decode.h"
#include "image/environment_exr.h"
#include "image/environment_memory.h"
#include "image/exr_sizes.h"
#include "image/image_header.h"
#include "image/oiio.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <memory>
#include <new>
#include <string_view>

namespace obscura {

namespace {

using ByteSpan = std::span<const std::byte>;

Result<Bytes> read_file(const std::filesystem::path& file) {
    FileBytes read = read_file_bytes(file, {});
    if (read.fault == FileFault::none) return std::move(read.bytes);
    return fail(ExitCode::bad_resource,
                "E-ENV-MISSING",
                file.string(),
                "the environment cannot be read: " + read.reason);
}

bool is_radiance_hdr(ByteSpan bytes) {
    return bytes.size() >= 2 && std::memcmp(bytes.data(), "#?", 2) == 0;
}

/// Consumes "<axis> <number>" at the front of `line`; 0 if there is something else.
int64_t take_side(std::string_view& line, std::string_view axis) {
    if (line.substr(0, axis.size()) != axis) return 0;
    line.remove_prefix(axis.size());
    int64_t side = 0;
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), side);
    line.remove_prefix(static_cast<size_t>(end - line.data()));
    return error == std::errc::result_out_of_range ? INT32_MAX : side;
}

/// Checks the line "-Y height +X width" that follows the header's empty line.
Result<void> check_hdr_size(ByteSpan bytes, const std::string& where) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const size_t empty_line = text.find("\n\n");
    if (empty_line == std::string_view::npos)
        return corrupt_environment(where, "the header is cut off");
    std::string_view line = text.substr(empty_line + 2);
    line = line.substr(0, line.find('\n'));
    const int64_t height = take_side(line, "-Y ");
    const int64_t width = take_side(line, " +X ");
    if (height < 1 || width < 1) {
        return corrupt_environment(where,
                                   "the header's size line must read '-Y <height> +X <width>'");
    }
    return check_environment_size(width, height, where);
}

Result<ImageRgb32f> read_hdr(ByteSpan bytes, const std::string& where) {
    if (auto fits = check_hdr_size(bytes, where); !fits) return fail(std::move(fits.error()));
    const Result<const OiioModule*>& oiio = oiio_module();
    if (!oiio) return fail(oiio.error());
    const std::unique_ptr<OiioInput> input = (*oiio)->open(bytes, "hdr");
    if (!input->error().empty()) return corrupt_environment(where, input->error());
    if (input->channels() != 3) return corrupt_environment(where, "does not have three channels");
    ImageRgb32f image{input->width(), input->height(), {}};
    if (auto fits = check_environment_size(image.width, image.height, where); !fits) {
        return fail(std::move(fits.error()));
    }
    image.pixels.resize(3 * static_cast<size_t>(image.width) * static_cast<size_t>(image.height));
    const bool read = input->read(OiioType::float32, image.pixels.data(), 3 * sizeof(float));
    const std::string complaint = input->errors();
    if (!read || !complaint.empty()) {
        return corrupt_environment(where, complaint.empty() ? "cut off or broken" : complaint);
    }
    return image;
}

float linear_from_srgb(double code) {
    return static_cast<float>(code <= 0.04045 ? code / 12.92
                                              : std::pow((code + 0.055) / 1.055, 2.4));
}

Result<ImageRgb32f> read_8_bit(ByteSpan bytes, const std::string& where, Log& log) {
    const auto renamed = [](Error error) {
        if (error.id.rfind("E-IMG-", 0) == 0) error.id.replace(0, 6, "E-ENV-");
        if (error.id == "E-ENV-FORMAT") error.message += ", Radiance HDR and OpenEXR";
        return fail(std::move(error));
    };
    const Result<ImageRgba8> header = probe_image(bytes, where);
    if (!header) return renamed(header.error());
    if (auto fits = check_environment_size(header->width, header->height, where); !fits) {
        return fail(std::move(fits.error()));
    }
    const Result<ImageRgba8> image = decode_image(bytes, where, log);
    if (!image) return renamed(image.error());
    std::array<float, 256> linear = {};
    for (size_t i = 0; i < 256; ++i)
        linear[i] = linear_from_srgb(static_cast<double>(i) / 255);
    ImageRgb32f result{image->width, image->height, {}};
    result.pixels.reserve(3 * image->texels.size());
    for (const uint32_t texel : image->texels) {
        for (const uint32_t shift : {0U, 8U, 16U}) {
            result.pixels.push_back(linear[texel >> shift & 0xFF]);
        }
    }
    return result;
}

/// Makes every value finite and not negative, and warns of the number of changed ones.
void clean(ImageRgb32f& image, const std::string& where, Log& log) {
    constexpr float largest_half = 65504;
    size_t replaced = 0;
    for (float& value : image.pixels) {
        if (value >= 0 && std::isfinite(value)) continue;
        value = value > 0 ? largest_half : 0.0f;
        ++replaced;
    }
    if (replaced > 0) {
        log.warn(where,
                 std::to_string(replaced) + " of " + std::to_string(image.pixels.size()) +
                     " values are negative, NaN or infinite; they became 0 or 65504");
    }
}

}  // namespace

Result<void> check_environment_size(int64_t width, int64_t height, const std::string& where) {
    constexpr int bytes_per_pixel = 3 * sizeof(float);
    if (auto fits = check_image_size(width, height, bytes_per_pixel, "E-ENV", where); !fits) {
        return fits;
    }
    // Asked here, before there are pixels; who keeps the environment charges it.
    const uint64_t bytes =
        environment_image_bytes(width, height) + environment_table_bytes(width, height);
    const auto has_room = charge_memory(MemoryUse::environment, where, bytes);
    if (!has_room) return fail(has_room.error());
    if (width == 2 * height) return {};
    return fail(ExitCode::bad_data,
                "E-ENV-ASPECT",
                where,
                std::to_string(width) + " x " + std::to_string(height) +
                    " pixels; a latitude-longitude environment is twice as wide as high");
}

Result<ImageRgb32f> read_environment(const std::filesystem::path& file, Log& log) {
    const std::string where = file.string();
    try {
        const Result<Bytes> bytes = read_file(file);
        if (!bytes) return fail(bytes.error());
        Result<ImageRgb32f> image = is_exr(*bytes)            ? read_exr(*bytes, where, log)
                                    : is_radiance_hdr(*bytes) ? read_hdr(*bytes, where)
                                                              : read_8_bit(*bytes, where, log);
        if (image) clean(*image, where, log);
        return image;
    } catch (const std::bad_alloc&) {
        return fail(ExitCode::out_of_memory, "E-ENV-MEMORY", where, "no memory for its pixels");
    } catch (const std::exception& error) {
        return corrupt_environment(where, error.what());
    }
}

}  // namespace obscura
