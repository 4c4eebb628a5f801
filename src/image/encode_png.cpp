// image/encode_png.cpp - encodes finished images as PNG, with what their colours mean.
// SPDX-License-Identifier: Apache-2.0
#include "image/encode.h"
#include "image/fingerprint.h"
#include "image/image_header.h"

#include <algorithm>
#include <array>
#include <bit>
#include <csetjmp>
#include <cstring>
#include <new>
#include <png.h>

namespace obscura {

namespace {

/// What libpng's functions for us get to see. It jumps over our frames when it gives up, so that
/// nothing in them may need a destructor.
struct PngSession {
    std::vector<std::byte>* out;
    std::array<char, 128> message;
};

[[noreturn]] void note_error(png_structp png, png_const_charp message) {
    auto* const session = static_cast<PngSession*>(png_get_error_ptr(png));
    std::strncpy(session->message.data(), message, session->message.size() - 1);
    png_longjmp(png, 1);
}

void ignore_warning(png_structp /*png*/, png_const_charp /*message*/) {}

void append_bytes(png_structp png, png_bytep data, size_t size) {
    auto* const session = static_cast<PngSession*>(png_get_io_ptr(png));
    bool has_room = true;
    try {
        const auto* const bytes = reinterpret_cast<const std::byte*>(data);
        session->out->insert(session->out->end(), bytes, bytes + size);
    } catch (const std::bad_alloc&) {
        has_room = false;  // an exception must not come to libpng's frames
    }
    if (!has_room) png_error(png, "out of memory");
}

void flush_nothing(png_structp /*png*/) {}

int color_type_of(int channels) {
    if (channels == 4) return PNG_COLOR_TYPE_RGB_ALPHA;
    if (channels == 2) return PNG_COLOR_TYPE_GRAY_ALPHA;
    return channels == 3 ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_GRAY;
}

/// A chunk sRGB for that encoding, cICP for another, neither for none.
///
/// Source  Portable Network Graphics, third edition, sections 11.3.2.5 and 11.3.2.6
void write_color_chunk(png_structp png, const std::optional<ColorCodePoints>& code_points) {
    if (!code_points) return;
    if (*code_points == srgb_code_points) {
        constexpr std::array<png_byte, 1> perceptual = {0};
        png_write_chunk(
            png, reinterpret_cast<png_const_bytep>("sRGB"), perceptual.data(), perceptual.size());
        return;
    }
    const std::array<png_byte, 4> data = {static_cast<png_byte>(code_points->primaries),
                                          static_cast<png_byte>(code_points->transfer),
                                          0,
                                          1};
    png_write_chunk(png, reinterpret_cast<png_const_bytep>("cICP"), data.data(), data.size());
}

/// Writes the file. False: libpng gave up, and the session has its message.
bool write_png(png_structp png, png_infop info, const PngImage& image, png_textp texts) {
    // NOLINTNEXTLINE(cert-err52-cpp,modernize-avoid-setjmp): how libpng tells of errors
    if (setjmp(png_jmpbuf(png)) != 0) return false;
    constexpr int compression = 4;  // the higher ones take a multiple of its time for some per cent
    constexpr int no_limit = 0x7FFFFFFF;
    png_set_user_limits(png, no_limit, no_limit);
    png_set_compression_level(png, compression);
    png_set_IHDR(png,
                 info,
                 static_cast<png_uint_32>(image.width),
                 static_cast<png_uint_32>(image.height),
                 image.bits,
                 color_type_of(image.channels),
                 PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    if (!image.texts.empty()) png_set_text(png, info, texts, static_cast<int>(image.texts.size()));
    png_write_info_before_PLTE(png, info);
    write_color_chunk(png, image.code_points);
    png_write_info(png, info);
    if (image.bits == 16 && std::endian::native == std::endian::little) png_set_swap(png);
    const auto stride = static_cast<size_t>(image.width) * static_cast<size_t>(image.channels) *
                        static_cast<size_t>(image.bits / 8);
    const auto* const rows = static_cast<const png_byte*>(image.codes);
    for (int y = 0; y < image.height; ++y)
        png_write_row(png, rows + static_cast<size_t>(y) * stride);
    png_write_end(png, nullptr);
    return true;
}

/// The texts as libpng takes them, which does not change them.
std::vector<png_text> texts_of(const PngImage& image) {
    std::vector<png_text> out;
    for (const auto& [name, text] : image.texts) {
        png_text one = {};
        one.compression = PNG_TEXT_COMPRESSION_NONE;
        one.key = const_cast<png_charp>(name.c_str());
        one.text = const_cast<png_charp>(text.c_str());
        one.text_length = text.size();
        out.push_back(one);
    }
    return out;
}

tl::unexpected<Error> png_error_of(const std::string& where, const std::string& message) {
    return fail(ExitCode::internal, "E-OUT-ENCODE", where, "libpng: " + message);
}

}  // namespace

Result<std::vector<std::byte>> encode_png(const PngImage& image, const std::string& where) {
    std::vector<std::byte> out;
    PngSession session = {&out, {}};
    png_structp png =
        png_create_write_struct(PNG_LIBPNG_VER_STRING, &session, note_error, ignore_warning);
    if (png == nullptr) return png_error_of(where, "it cannot begin; memory may be short");
    png_infop info = png_create_info_struct(png);
    std::vector<png_text> texts = texts_of(image);
    png_set_write_fn(png, &session, append_bytes, flush_nothing);
    const bool done = info != nullptr && write_png(png, info, image, texts.data());
    png_destroy_write_struct(&png, &info);
    if (!done) return png_error_of(where, session.message.data());
    return out;
}

std::optional<std::string> fingerprint_of_png(const std::vector<std::byte>& file) {
    const Result<ImageHeader> header = read_image_header(file, "");
    if (!header || header->format != ImageFormat::png) return {};
    const std::string_view bytes(reinterpret_cast<const char*>(file.data()), file.size());
    const std::string keyword = std::string(fingerprint_name) + '\0';
    std::string found;
    constexpr size_t signature = 8;
    for (size_t at = signature;;) {  // all chunks are there: the header has been read
        const size_t length = png_get_uint_32(reinterpret_cast<png_const_bytep>(&file[at]));
        const std::string_view type = bytes.substr(at + 4, 4);
        const std::string_view data = bytes.substr(at + 8, length);
        if (type == "tEXt" && data.starts_with(keyword)) found = data.substr(keyword.size());
        if (type == "IEND") return at + 12 <= bytes.size() ? std::optional(found) : std::nullopt;
        at += length + 12;
    }
}

}  // namespace obscura
