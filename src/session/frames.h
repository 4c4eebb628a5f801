// session/frames.h - the frames of a sequence: their numbers, times and file names.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

namespace obscura {

/// Frame n is at n / fps seconds.
struct FrameList {
    std::vector<int> numbers;  ///< in the order of rendering, each once
    double fps = 24;

    double time_s(int frame) const { return frame / fps; }
};

/// Open shutter, in frames relative to the image's time.
struct ShutterFractions {
    double open = 0;
    double close = 0;
};

/// The name of one frame's file: the only run of # in the file's name becomes the number, with
/// zeros in front up to as many digits as there are #. Nothing: there is no such run, or several.
std::optional<std::filesystem::path> frame_file(const std::filesystem::path& pattern, int frame);

}  // namespace obscura
