// app/frames.h - the frames of a sequence: their numbers, times and file names.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace obscura {

/// --frames and --fps; frame n is at n / fps seconds.
struct FrameRange {
    int first = 0;
    int last = 0;  ///< inclusive
    double fps = 24;

    int count() const { return last - first + 1; }
    double time_s(int frame) const { return frame / fps; }
};

/// While the shutter is open, in frames from the picture's own time.
struct ShutterFractions {
    double open = 0;
    double close = 0;
};

/// True for a --shutter of the form OPEN,CLOSE; one of seconds is an exposure time.
bool is_shutter_interval(std::string_view text);

/// "0,0.5" or "-0.25,0.25".
///
/// Errors  64 E-USAGE-NUMBER, E-USAGE-RANGE: two numbers from -1000 to 1000, the second the greater
Result<ShutterFractions> parse_shutter_interval(const std::string& text);

/// "1-120", or "7" for one frame.
///
/// Errors  64 E-USAGE-NUMBER, E-USAGE-RANGE: numbers from 0 to 999999, the second not below the
///         first
Result<FrameRange> parse_frames(std::string_view text, std::string_view option);

/// The name of one frame's file: the only run of # in the file's name becomes the number, with
/// zeros in front up to as many digits as there are #. Nothing: there is no such run, or several.
std::optional<std::filesystem::path> frame_file(const std::filesystem::path& pattern, int frame);

/// One picture of a command: where it goes and when it is.
struct MovieFrame {
    std::optional<int> number;  ///< of a sequence
    double time_s = 0;
    std::vector<std::filesystem::path> outputs;
};

}  // namespace obscura
