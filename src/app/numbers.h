// app/numbers.h - the strict reading of numbers, sizes and points from command-line text.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/text.h"
#include "math/vec.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace obscura::app {

/// Numbers are read alike in every locale: a point, no grouping, no blanks, nothing else.
///
/// In      option: the name for messages, such as "--spp"; low, high: inclusive
/// Errors  64 E-USAGE-NUMBER not a number, 64 E-USAGE-RANGE outside [low, high]; both say what
///         would be accepted
Result<int64_t> parse_integer(std::string_view text,
                              std::string_view option,
                              int64_t low,
                              int64_t high);
Result<uint64_t> parse_unsigned(std::string_view text, std::string_view option);
Result<double> parse_real(std::string_view text, std::string_view option, double low, double high);

/// A length and what it is counted in.
struct ParsedLength {
    double value = 0;
    bool pixels = false;  ///< else metres
};

/// "0.01" or "0.01m" in metres, from 1e-9 to 1e9; "3px" in pixels, from 0.01 to 1000.
Result<ParsedLength> parse_length(std::string_view text, std::string_view option);

/// "1280x720": width and height in pixels, each in [1, 65536], at most 2^29 pixels in all.
Result<std::array<int, 2>> parse_size(std::string_view text, std::string_view option);

/// "1280x720".
std::string size_text(const std::array<int, 2>& size);

/// "x,y,z" with finite components of magnitude up to 1e18.
Result<Vec3d> parse_point(std::string_view text, std::string_view option);

/// white, black, grey or gray, as style sheets define them, or "#RRGGBB": sRGB-encoded values in
/// [0, 1]; nothing for other texts.
std::optional<std::array<float, 3>> encoded_color(std::string_view text);

/// A linear colour: "r,g,b", each in [0, 1e9], or that of encoded_color.
Result<std::array<float, 3>> parse_color(std::string_view text, std::string_view option);

/// A display's encoded values: "r,g,b", each in [0, 1], or encoded_color.
Result<std::array<float, 3>> parse_page(const std::string& text, const std::string& option);

/// "X,Y,W,H" of integers; width and height at least 1, corner at least 0.
Result<std::array<int, 4>> parse_rectangle(std::string_view text, std::string_view option);

/// "X,Y" of pixels from the top left corner, each at least 0.
Result<std::array<int, 2>> parse_pixel(std::string_view text, std::string_view option);

/// Limits of a list of numbers.
struct NumberList {
    std::string accepted;  ///< for messages
    size_t least, most;    ///< how many
    double low, high;      ///< inclusive
};

/// "a,b,c" without blanks.
Result<std::vector<double>> parse_numbers(std::string_view text,
                                          std::string_view option,
                                          const NumberList& list);

}  // namespace obscura::app
