// session/frames.cpp - the frames of a sequence: their file names.
// SPDX-License-Identifier: Apache-2.0
#include "session/frames.h"

#include <algorithm>
#include <string>

namespace obscura {

std::optional<std::filesystem::path> frame_file(const std::filesystem::path& pattern, int frame) {
    const std::string name = pattern.filename().string();
    const size_t begin = name.find('#');
    if (begin == std::string::npos) return std::nullopt;
    const size_t end = std::min(name.find_first_not_of('#', begin), name.size());
    if (name.find('#', end) != std::string::npos) return std::nullopt;
    std::string digits = std::to_string(frame);
    const size_t width = end - begin;
    if (digits.size() < width) digits.insert(0, width - digits.size(), '0');
    return pattern.parent_path() / (name.substr(0, begin) + digits + name.substr(end));
}

}  // namespace obscura
