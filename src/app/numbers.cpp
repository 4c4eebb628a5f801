// app/numbers.cpp - the strict reading of numbers, sizes and points from command-line text.
// SPDX-License-Identifier: Apache-2.0
#include "app/numbers.h"

#include "surface/srgb.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

namespace obscura::app {

namespace {

constexpr int64_t max_side = 65536;
constexpr int64_t max_pixels = int64_t{1} << 29;

tl::unexpected<Error> not_a_number(std::string_view text,
                                   std::string_view option,
                                   const std::string& accepted) {
    return fail(ExitCode::usage,
                "E-USAGE-NUMBER",
                std::string(option),
                in_quotes(text) + " is not accepted; expected " + accepted);
}

tl::unexpected<Error> out_of_range(std::string_view text,
                                   std::string_view option,
                                   const std::string& accepted) {
    return fail(ExitCode::usage,
                "E-USAGE-RANGE",
                std::string(option),
                in_quotes(text) + " is out of range; expected " + accepted);
}

enum class Reading { good, garbage, overflow };

/// Three numbers as a colour.
Result<std::array<float, 3>> parse_rgb(std::string_view text,
                                       std::string_view option,
                                       const NumberList& accepted) {
    const Result<std::vector<double>> list = parse_numbers(text, option, accepted);
    if (!list) return fail(list.error());
    return std::array<float, 3>{static_cast<float>((*list)[0]),
                                static_cast<float>((*list)[1]),
                                static_cast<float>((*list)[2])};
}

/// Reads all of the text as one number; a single leading plus is allowed.
template <typename T>
Reading read_all(std::string_view text, T& number) {
    if (text.size() > 1 && text[0] == '+' && text[1] != '-' && text[1] != '+') {
        text.remove_prefix(1);
    }
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (end != text.data() + text.size() || error == std::errc::invalid_argument) {
        return Reading::garbage;
    }
    return error == std::errc() ? Reading::good : Reading::overflow;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    size_t begin = 0;
    for (size_t i = 0; i <= text.size(); ++i) {
        if (i == text.size() || text[i] == separator) {
            parts.push_back(text.substr(begin, i - begin));
            begin = i + 1;
        }
    }
    return parts;
}

}  // namespace

Result<int64_t> parse_integer(std::string_view text,
                              std::string_view option,
                              int64_t low,
                              int64_t high) {
    const std::string accepted =
        "a whole number from " + std::to_string(low) + " to " + std::to_string(high);
    int64_t number = 0;
    const Reading reading = read_all(text, number);
    if (reading == Reading::garbage) return not_a_number(text, option, accepted);
    if (reading == Reading::overflow || number < low || number > high) {
        return out_of_range(text, option, accepted);
    }
    return number;
}

Result<uint64_t> parse_unsigned(std::string_view text, std::string_view option) {
    const std::string accepted = "a whole number from 0 to 18446744073709551615";
    uint64_t number = 0;
    const Reading reading = read_all(text, number);
    if (reading == Reading::garbage) return not_a_number(text, option, accepted);
    if (reading == Reading::overflow) return out_of_range(text, option, accepted);
    return number;
}

Result<double> parse_real(std::string_view text, std::string_view option, double low, double high) {
    const std::string accepted = "a number from " + shortest(low) + " to " + shortest(high);
    double number = 0;
    const Reading reading = read_all(text, number);
    if (reading == Reading::garbage || std::isnan(number)) {
        return not_a_number(text, option, accepted);
    }
    if (reading == Reading::overflow || number < low || number > high) {
        return out_of_range(text, option, accepted);
    }
    return number;
}

Result<ParsedLength> parse_length(std::string_view text, std::string_view option) {
    const std::string accepted =
        "metres from 1e-9 to 1e9, such as 0.01 or 0.01m, or pixels from 0.01 to 1000, such as 3px";
    const auto ends_with = [&](std::string_view unit) {
        return text.size() > unit.size() && text.substr(text.size() - unit.size()) == unit;
    };
    const bool pixels = ends_with("px");
    const size_t unit = pixels ? 2 : (ends_with("m") ? 1 : 0);
    double number = 0;
    const Reading reading = read_all(text.substr(0, text.size() - unit), number);
    if (reading == Reading::garbage || std::isnan(number)) {
        return not_a_number(text, option, accepted);
    }
    const double low = pixels ? 0.01 : 1e-9;
    const double high = pixels ? 1000 : 1e9;
    if (reading == Reading::overflow || number < low || number > high) {
        return out_of_range(text, option, accepted);
    }
    return ParsedLength{number, pixels};
}

Result<std::array<int, 2>> parse_size(std::string_view text, std::string_view option) {
    const std::string accepted =
        "WIDTHxHEIGHT in pixels, such as 1280x720, each from 1 to 65536, at most 536870912 pixels "
        "in all";
    const std::vector<std::string_view> parts = split(text, 'x');
    if (parts.size() != 2) return not_a_number(text, option, accepted);
    std::array<int64_t, 2> sides = {};
    for (size_t i = 0; i < 2; ++i) {
        const Reading reading = read_all(parts[i], sides[i]);
        if (reading == Reading::garbage) return not_a_number(text, option, accepted);
        if (reading == Reading::overflow || sides[i] < 1 || sides[i] > max_side) {
            return out_of_range(text, option, accepted);
        }
    }
    if (sides[0] * sides[1] > max_pixels) return out_of_range(text, option, accepted);
    return std::array<int, 2>{static_cast<int>(sides[0]), static_cast<int>(sides[1])};
}

std::string size_text(const std::array<int, 2>& size) {
    return std::to_string(size[0]) + "x" + std::to_string(size[1]);
}

Result<Vec3d> parse_point(std::string_view text, std::string_view option) {
    const Result<std::vector<double>> list = parse_numbers(
        text, option, {"x,y,z in metres without blanks, such as 0,1.5,-3", 3, 3, -1e18, 1e18});
    if (!list) return fail(list.error());
    return Vec3d{(*list)[0], (*list)[1], (*list)[2]};
}

std::optional<std::array<float, 3>> encoded_color(std::string_view text) {
    constexpr float middle = 128.0f / 255;
    if (text == "white") return std::array<float, 3>{1, 1, 1};
    if (text == "black") return std::array<float, 3>{0, 0, 0};
    if (text == "grey" || text == "gray") return std::array<float, 3>{middle, middle, middle};
    if (text.size() != 7 || text[0] != '#') return std::nullopt;
    std::array<float, 3> color = {};
    for (size_t i = 0; i < 3; ++i) {
        const char* const begin = text.data() + 1 + 2 * i;
        unsigned code = 0;
        const auto [end, error] = std::from_chars(begin, begin + 2, code, 16);
        if (end != begin + 2 || error != std::errc()) return std::nullopt;
        color[i] = static_cast<float>(code) / 255;
    }
    return color;
}

Result<std::array<float, 3>> parse_color(std::string_view text, std::string_view option) {
    if (std::optional<std::array<float, 3>> color = encoded_color(text)) {
        for (float& channel : *color)
            channel = linear_from_srgb(channel);
        return *color;
    }
    return parse_rgb(text,
                     option,
                     {"env, transparent, white, black, grey, #RRGGBB, or linear R,G,B without "
                      "blanks, each from 0 to 1e9",
                      3,
                      3,
                      0,
                      1e9});
}

Result<std::array<float, 3>> parse_page(const std::string& text, const std::string& option) {
    if (const std::optional<std::array<float, 3>> color = encoded_color(text)) return *color;
    return parse_rgb(
        text,
        option,
        {"white, black, grey, #RRGGBB, or the display's R,G,B, each from 0 to 1", 3, 3, 0, 1});
}

Result<std::array<int, 4>> parse_rectangle(std::string_view text, std::string_view option) {
    const std::string accepted =
        "X,Y,WIDTH,HEIGHT in pixels from the top left corner, such as 0,0,64,64";
    const std::vector<std::string_view> parts = split(text, ',');
    if (parts.size() != 4) return not_a_number(text, option, accepted);
    std::array<int, 4> numbers = {};
    for (size_t i = 0; i < 4; ++i) {
        const Reading reading = read_all(parts[i], numbers[i]);
        if (reading == Reading::garbage) return not_a_number(text, option, accepted);
        const int low = i < 2 ? 0 : 1;
        if (reading == Reading::overflow || numbers[i] < low || numbers[i] > max_side) {
            return out_of_range(text, option, accepted);
        }
    }
    return numbers;
}

Result<std::array<int, 2>> parse_pixel(std::string_view text, std::string_view option) {
    const std::string accepted = "X,Y in pixels from the top left corner, such as 640,360";
    const Result<std::vector<double>> list =
        parse_numbers(text, option, {accepted, 2, 2, 0, max_side});
    if (!list) return fail(list.error());
    std::array<int, 2> pixel = {};
    for (size_t i = 0; i < 2; ++i) {
        pixel[i] = static_cast<int>((*list)[i]);
        if (pixel[i] != (*list)[i]) return not_a_number(text, option, accepted);
    }
    return pixel;
}

Result<std::vector<double>> parse_numbers(std::string_view text,
                                          std::string_view option,
                                          const NumberList& list) {
    std::vector<double> numbers;
    for (const std::string_view part : split(text, ',')) {
        double number = 0;
        const Reading reading = read_all(part, number);
        if (reading == Reading::garbage) return not_a_number(text, option, list.accepted);
        if (reading == Reading::overflow || !(number >= list.low && number <= list.high)) {
            return out_of_range(text, option, list.accepted);
        }
        numbers.push_back(number);
    }
    if (numbers.size() < list.least || numbers.size() > list.most) {
        return not_a_number(text, option, list.accepted);
    }
    return numbers;
}

}  // namespace obscura::app
