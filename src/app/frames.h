// app/frames.h - texts of sequences: their frames, names of their files, the open shutter.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "session/frames.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace obscura::app {

/// True for a --shutter of the form OPEN,CLOSE; one of seconds is an exposure time.
bool is_shutter_interval(std::string_view text);

/// "0,0.5" or "-0.25,0.25".
///
/// Errors  64 E-USAGE-NUMBER, E-USAGE-RANGE: two numbers from -1000 to 1000, the second the greater
Result<ShutterFractions> parse_shutter_interval(const std::string& text);

/// "1-120"; "7" for one frame; "1-10x2" for every second one; several of these, as "1,120,2-119".
/// A frame that is named again is not rendered again.
///
/// Errors  64 E-USAGE-NUMBER, E-USAGE-RANGE: numbers from 0 to 999999, the second not below the
///         first, steps from 1
Result<FrameList> parse_frames(std::string_view text, std::string_view option);

/// The names of a sequence's files must say where the frame's number goes.
///
/// Errors  64 E-USAGE-CONFLICT
Result<void> check_frame_patterns(const std::vector<std::filesystem::path>& patterns);

}  // namespace obscura::app
