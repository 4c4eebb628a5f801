// serve/program_output.h - what `obscura batch` printed: its messages and its RESULT line.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"

#include <filesystem>
#include <optional>
#include <string>

namespace obscura::serve {

struct ProgramOutput {
    std::optional<Error> error;  ///< of a RESULT line whose code is not 0, with the ERROR lines
    int warnings = 0;            ///< of the RESULT line
    int images = 0;              ///< that a dry run counted
};

/// Reads standard error of the program.
ProgramOutput parse_program_output(const std::string& text);

/// The error of a program that ended by itself or by a signal without a word.
///
/// In      code: as ChildProcess::code says it
Error error_of_code(int code);

/// The last bytes of a text file, from the beginning of a line on; "": it cannot be read.
std::string end_of_file(const std::filesystem::path& file, size_t max_bytes);

}  // namespace obscura::serve
