// serve/program_output.cpp - what `obscura batch` printed: its messages and its RESULT line.
// SPDX-License-Identifier: Apache-2.0
#include "serve/program_output.h"

#include <charconv>
#include <fstream>
#include <sstream>
#include <string_view>

namespace obscura::serve {

namespace {

int whole_number(std::string_view text) {
    int value = 0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value;
}

/// The value of "name=value" in a RESULT line.
std::string field(const std::string& line, const std::string& name) {
    const std::string start = " " + name + "=";
    const size_t at = line.find(start);
    if (at == std::string::npos) return "";
    const size_t begin = at + start.size();
    return line.substr(begin, line.find(' ', begin) - begin);
}

/// As it was before the program made one word of it.
std::string with_spaces(std::string text) {
    constexpr std::string_view space = "\\x20";
    for (size_t at = 0; (at = text.find(space, at)) != std::string::npos; ++at)
        text.replace(at, space.size(), " ");
    return text;
}

/// The error of "place: text [E-ID]", where the place is known or not.
Error error_of_line(std::string line, const std::string& where) {
    Error out;
    const size_t id = line.rfind(" [E-");
    if (id != std::string::npos && line.ends_with(']')) {
        out.id = line.substr(id + 2, line.size() - id - 3);
        line.resize(id);
    }
    size_t colon = line.find(": ");
    if (!where.empty() && line.starts_with(where + ": ")) colon = where.size();
    if (colon != std::string::npos) {
        out.where = line.substr(0, colon);
        line.erase(0, colon + 2);
    }
    out.message = line;
    return out;
}

}  // namespace

ProgramOutput parse_program_output(const std::string& text) {
    constexpr std::string_view error_start = "ERROR ", info_start = "INFO ", images = " images";
    ProgramOutput out;
    std::vector<std::string> errors;
    std::string result;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) {
        if (line.starts_with("RESULT ")) result = line;
        if (line.starts_with(error_start)) errors.push_back(line.substr(error_start.size()));
        if (line.starts_with(info_start) && line.ends_with(images))
            out.images += whole_number(std::string_view(line).substr(info_start.size()));
    }
    out.warnings = whole_number(field(result, "warnings"));
    const int code = whole_number(field(result, "code"));
    if (code == 0) return out;
    Error error{static_cast<ExitCode>(code), field(result, "id"), "", ""};
    error.where = with_spaces(field(result, "where"));
    for (size_t i = 0; i < errors.size(); ++i) {
        Error one = error_of_line(errors[i], i == 0 ? error.where : "");
        if (i == 0) {
            error.message = one.message;
        } else {
            one.code = error.code;
            error.also.push_back(std::move(one));
        }
    }
    out.error = std::move(error);
    return out;
}

Error error_of_code(int code) {
    constexpr int signal_base = 128;
    const std::string how = code > signal_base
                                ? "was ended by signal " + std::to_string(code - signal_base)
                                : "ended with code " + std::to_string(code);
    return {ExitCode::internal, "E-INTERNAL", "job", "its process " + how + " without a message"};
}

std::string end_of_file(const std::filesystem::path& file, size_t max_bytes) {
    std::ifstream in(file, std::ios::binary | std::ios::ate);
    if (!in) return "";
    const auto size = static_cast<size_t>(in.tellg());
    const size_t begin = size > max_bytes ? size - max_bytes : 0;
    in.seekg(static_cast<std::streamoff>(begin));
    std::string text(size - begin, '\0');
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<size_t>(in.gcount()));
    if (begin > 0) text.erase(0, text.find('\n') + 1);
    return text;
}

}  // namespace obscura::serve
