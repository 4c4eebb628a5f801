// image/exr_sizes.cpp - the sizes in OpenEXR headers, before the library allocates memory by them.
// SPDX-License-Identifier: Apache-2.0
#include "image/exr_sizes.h"

#include <algorithm>
#include <cstring>
#include <string_view>

namespace obscura {

namespace {

using ByteSpan = std::span<const std::byte>;

/// Reads the bytes of a header; after the end everything is empty or 0.
struct HeaderReader {
    ByteSpan rest;

    std::string_view text() {
        const auto* begin = reinterpret_cast<const char*>(rest.data());
        const std::string_view all(begin, rest.size());
        const std::string_view found = all.substr(0, all.find('\0'));
        rest = rest.subspan(std::min(found.size() + 1, rest.size()));
        return found;
    }
    int32_t number() {
        int32_t value = 0;
        if (rest.size() >= sizeof value) std::memcpy(&value, rest.data(), sizeof value);
        skip(sizeof value);
        return value;
    }
    void skip(size_t count) { rest = rest.subspan(std::min(count, rest.size())); }
};

/// The sizes in one part's header, by which OpenEXR allocates memory when it opens a file.
struct PartSize {
    bool is_whole = false;  ///< its end was found
    std::optional<std::array<int64_t, 2>> window;
    std::array<uint32_t, 2> tile = {1, 1};
};

PartSize read_part(HeaderReader& reader) {
    PartSize part;
    while (!reader.rest.empty()) {
        const std::string_view name = reader.text();
        if (name.empty()) {
            part.is_whole = true;
            break;
        }
        const std::string_view type = reader.text();
        const int32_t size = reader.number();
        if (size < 0 || static_cast<size_t>(size) > reader.rest.size()) break;
        HeaderReader value{reader.rest.first(static_cast<size_t>(size))};
        reader.skip(static_cast<size_t>(size));
        if (name == "dataWindow" && type == "box2i" && size == 16) {
            const int64_t left = value.number();
            const int64_t top = value.number();
            const int64_t right = value.number();
            const int64_t bottom = value.number();
            part.window = {right - left + 1, bottom - top + 1};
        } else if (name == "tiles" && type == "tiledesc") {
            const auto width = static_cast<uint32_t>(value.number());
            part.tile = {width, static_cast<uint32_t>(value.number())};
        }
    }
    return part;
}

}  // namespace

bool is_exr(ByteSpan bytes) {
    constexpr unsigned char magic[] = {0x76, 0x2F, 0x31, 0x01};
    return bytes.size() >= sizeof magic && std::memcmp(bytes.data(), magic, sizeof magic) == 0;
}

ExrSizes read_exr_sizes(ByteSpan bytes) {
    constexpr size_t magic_bytes = 4;
    constexpr int32_t several_parts = 0x1000;
    ExrSizes out;
    HeaderReader reader{bytes};
    reader.skip(magic_bytes);
    const bool has_parts = (reader.number() & several_parts) != 0;
    for (bool is_first = true; is_first || has_parts; is_first = false) {
        const PartSize part = read_part(reader);
        if (is_first) out.window = part.window;
        for (const int64_t side : part.window.value_or(std::array<int64_t, 2>{1, 1}))
            out.longest_side = std::max(out.longest_side, side);
        for (const int64_t side : part.tile)
            out.longest_side = std::max(out.longest_side, side);
        if (!part.is_whole || reader.rest.empty() || reader.rest.front() == std::byte{0}) break;
    }
    return out;
}

}  // namespace obscura
