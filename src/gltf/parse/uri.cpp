// gltf/parse/uri.cpp - the bytes of a data URI, or of a file in the asset's folder.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/uri.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace obscura::gltf {

namespace {

int hex_value(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

constexpr std::array<int8_t, 256> make_base64_values() {
    constexpr std::string_view alphabet =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::array<int8_t, 256> out{};
    for (int8_t& value : out)
        value = -1;
    for (size_t i = 0; i < alphabet.size(); ++i) {
        out[static_cast<unsigned char>(alphabet[i])] = static_cast<int8_t>(i);
    }
    return out;
}

constexpr std::array<int8_t, 256> base64_values = make_base64_values();

/// URIs of data may be megabytes: messages show the beginning only.
std::string shown(std::string_view uri) {
    constexpr size_t longest = 120;
    std::string out(1, '"');
    out += uri.substr(0, longest);
    out += uri.size() <= longest ? "\"" : "...\"";
    return out;
}

/// Length of a leading "scheme" before a colon, 0 if there is none.
size_t scheme_length(std::string_view uri) {
    const size_t colon = uri.find(':');
    if (colon == std::string_view::npos || colon == 0) return 0;
    const auto is_scheme_character = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '+' || c == '-' || c == '.';
    };
    if (std::isalpha(static_cast<unsigned char>(uri[0])) == 0) return 0;
    const std::string_view scheme = uri.substr(0, colon);
    return std::all_of(scheme.begin(), scheme.end(), is_scheme_character) ? colon : 0;
}

tl::unexpected<Error> refuse(std::string_view uri, const std::string& where, const char* why) {
    return fail(ExitCode::refused,
                "E-URI-REFUSED",
                where,
                shown(uri) + " " + why +
                    "; accepted are data: URIs and relative paths inside the asset's folder");
}

bool lies_inside(const std::filesystem::path& path, const std::filesystem::path& folder) {
    const auto ends = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
    return ends.first == folder.end();
}

tl::unexpected<Error> missing(std::string_view uri,
                              const std::string& where,
                              const std::string& why) {
    return fail(ExitCode::bad_resource,
                "E-RES-MISSING",
                where,
                "the file " + shown(uri) + " cannot be read: " + why);
}

/// Schemes and encodings are the same in either case.
bool is_same_word(std::string_view a, std::string_view lower_case) {
    return std::equal(
        a.begin(), a.end(), lower_case.begin(), lower_case.end(), [](char c, char lower) {
            return std::tolower(static_cast<unsigned char>(c)) == lower;
        });
}

/// Source  RFC 2397
Result<UriBytes> read_data_uri(std::string_view uri,
                               const std::string& where,
                               const ReadLimits& limits) {
    const size_t comma = uri.find(',');
    const auto broken = [&](const std::string& why) {
        return fail(
            ExitCode::bad_data,
            "E-URI-DATA",
            where,
            shown(uri) + " " + why +
                "; accepted are data:<media type>;base64,<data> and data:<media type>,<data>");
    };
    if (comma == std::string_view::npos) return broken("has no comma");
    const std::string_view header = uri.substr(5, comma - 5);
    constexpr std::string_view base64 = ";base64";
    const bool is_base64 = header.size() >= base64.size() &&
                           is_same_word(header.substr(header.size() - base64.size()), base64);
    UriBytes out;
    out.mime = std::string(header.substr(0, header.find(';')));
    const std::string_view data = uri.substr(comma + 1);
    if (limits.charge) {
        const uint64_t bytes = is_base64 ? data.size() / 4 * 3 : data.size();
        if (auto fits = limits.charge(bytes); !fits) return fail(std::move(fits.error()));
    }
    if (is_base64) {
        const std::string fault = decode_base64(data, out.bytes);
        if (!fault.empty()) return broken(fault);
    } else {
        for (const char c : percent_decode(data))
            out.bytes.push_back(static_cast<std::byte>(c));
    }
    out.size = out.bytes.size();
    return out;
}

}  // namespace

bool is_data_uri(std::string_view uri) {
    return is_same_word(uri.substr(0, 5), "data:");
}

std::string percent_decode(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    for (size_t i = 0; i < text.size(); ++i) {
        const int high = text[i] == '%' && i + 2 < text.size() ? hex_value(text[i + 1]) : -1;
        const int low = high >= 0 ? hex_value(text[i + 2]) : -1;
        if (low < 0) {
            out += text[i];
            continue;
        }
        out += static_cast<char>(high * 16 + low);
        i += 2;
    }
    return out;
}

std::string decode_base64(std::string_view text, Bytes& out) {
    size_t padding = 0;
    while (padding < 2 && !text.empty() && text.back() == '=') {
        text.remove_suffix(1);
        ++padding;
    }
    if (text.size() % 4 == 1) return "has an incomplete base64 group";
    if (padding != 0 && (text.size() + padding) % 4 != 0) return "has wrong base64 padding";
    out.clear();
    out.reserve(text.size() / 4 * 3 + 2);
    uint32_t bits = 0;
    int bit_count = 0;
    for (size_t i = 0; i < text.size(); ++i) {
        const int8_t value = base64_values[static_cast<unsigned char>(text[i])];
        if (value < 0) return "has a character at " + std::to_string(i) + " that is not base64";
        bits = (bits << 6 | static_cast<uint32_t>(value)) & 0xFFFFFFU;
        bit_count += 6;
        if (bit_count >= 8) {
            bit_count -= 8;
            out.push_back(static_cast<std::byte>(bits >> bit_count & 255U));
        }
    }
    return {};
}

Result<std::filesystem::path> relative_path_from_uri(std::string_view uri,
                                                     const std::string& where) {
    if (uri.empty()) return refuse(uri, where, "is empty");
    const std::string text = percent_decode(uri);
    // An encoded colon does not make a scheme, but a drive letter is one either way.
    const bool drive = text.size() >= 2 && text[1] == ':' &&
                       std::isalpha(static_cast<unsigned char>(text[0])) != 0;
    if (drive) return refuse(uri, where, "names a drive");
    if (scheme_length(uri) != 0) return refuse(uri, where, "has a scheme; nothing is downloaded");
    if (text[0] == '/') return refuse(uri, where, "is absolute");
    int depth = 0;
    std::filesystem::path out;
    size_t begin = 0;
    while (begin <= text.size()) {
        const size_t end = std::min(text.find('/', begin), text.size());
        const std::string part = text.substr(begin, end - begin);
        depth += part == ".." ? -1 : part.empty() || part == "." ? 0 : 1;
        if (depth < 0) return refuse(uri, where, "leaves the asset's folder");
        out /= part;
        begin = end + 1;
    }
    const auto is_forbidden = [](char c) {
        return static_cast<unsigned char>(c) < 0x20 || c == 0x7F || c == '\\';
    };
    if (std::any_of(text.begin(), text.end(), is_forbidden)) {
        return refuse(uri, where, "has a backslash or a control character");
    }
    return out;
}

Result<UriBytes> read_uri(std::string_view uri,
                          const UriContext& context,
                          const ReadLimits& limits) {
    if (is_data_uri(uri)) return read_data_uri(uri, context.where, limits);
    Result<std::filesystem::path> relative = relative_path_from_uri(uri, context.where);
    if (!relative) return fail(std::move(relative.error()));

    std::error_code code;
    const std::filesystem::path start = context.folder.empty() ? "." : context.folder;
    const std::filesystem::path folder = std::filesystem::canonical(start, code);
    if (code) return missing(uri, context.where, code.message());
    const std::filesystem::path path = std::filesystem::canonical(folder / *relative, code);
    if (code) return missing(uri, context.where, code.message());
    if (!lies_inside(path, folder)) {
        return refuse(uri, context.where, "leaves the asset's folder through a symbolic link");
    }

    FileBytes file = read_file_bytes(path, limits);
    if (file.refusal) return fail(std::move(*file.refusal));
    switch (file.fault) {
        case FileFault::none:
            break;
        case FileFault::not_a_file:
            return refuse(uri, context.where, "is not a regular file");
        case FileFault::too_large:
            return fail(ExitCode::refused,
                        "E-LIMIT-FILE",
                        context.where,
                        "the file " + shown(uri) + " has " + file.reason);
        default:
            return missing(uri, context.where, file.reason);
    }
    return UriBytes{std::move(file.bytes), {}, file.size};
}

}  // namespace obscura::gltf
