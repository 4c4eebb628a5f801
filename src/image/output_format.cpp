// image/output_format.cpp - finds a format by the ending of a file's name.
// SPDX-License-Identifier: Apache-2.0
#include "image/output_format.h"

#include <vector>

namespace obscura {

const OutputFormatEntry& entry_of(OutputFormat format) noexcept {
    return output_formats[static_cast<size_t>(format)];
}

std::optional<OutputFormat> output_format_of(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    for (char& c : extension) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    for (const OutputFormatEntry& entry : output_formats) {
        for (const char* ending : entry.endings) {
            if (ending && extension == ending) return entry.value;
        }
    }
    return std::nullopt;
}

std::string output_endings() {
    std::vector<std::string> endings;
    for (const OutputFormatEntry& entry : output_formats) {
        for (const char* ending : entry.endings) {
            if (ending) endings.emplace_back(ending);
        }
    }
    std::string list;
    for (size_t i = 0; i < endings.size(); ++i) {
        list += (i == 0 ? "" : i + 1 == endings.size() ? " and " : ", ") + endings[i];
    }
    return list;
}

}  // namespace obscura
