// tests/layout/rules.h - the machine-checked house rules: who includes what, and how long.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "layout/source_text.h"
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace obscura::layout {

inline constexpr size_t max_file_lines = 500;
inline constexpr size_t max_function_lines = 60;
inline constexpr size_t max_columns = 100;
inline constexpr size_t max_parameters = 5;

/// The rooms in order of data flow: each may include itself and those before it.
inline constexpr std::array<std::string_view, 21> rooms{
    "base",    "math",    "shape", "camera",     "surface", "light",  "image",
    "scene",   "gltf",    "accel", "stages",     "film",    "render", "denoise",
    "session", "dataset", "serve", "crosscheck", "explain", "bench",  "app"};

/// Which rooms may include headers whose name begins with `prefix`.
struct Owner {
    std::string_view prefix;
    std::string_view rooms;  ///< separated by spaces
};

/// To add a library: one line here, one in third_party/README.md, one in third_party/packages.txt.
inline constexpr std::array<Owner, 28> owners{
    {{"tbb/", "base"},
     {"oneapi/", "base"},
     {"tl/", "base"},
     {"openssl/", "base"},
     {"xsimd", "math"},
     {"immintrin.h", "base math"},
     {"arm_neon.h", "base math"},
     {"OpenImageIO/", "image"},
     {"OpenEXR/", "image"},
     {"Imath/", "image"},
     {"OpenColorIO/", "image"},
     {"webp/", "image"},
     {"png.h", "image"},
     {"zstd", "image"},
     {"isa-l/", "image"},
     {"nlohmann/", "base gltf"},
     {"tiny_gltf.h", "gltf"},
     {"draco/", "gltf"},
     {"meshoptimizer", "gltf"},
     {"embree3/", "accel"},
     {"embree4/", "accel"},
     {"httplib.h", "serve"},
     {"arpa/", "serve"},
     {"netinet/", "serve"},
     {"CLI/", "app"},
     {"netdb.h", "app"},  // of all rooms, only this one uses the network
     {"obscura/", "session"},
     {"fmt/", "image session dataset crosscheck explain bench app"}}};

/// Public headers of rooms so large that they have an inside.
struct PublicHeaders {
    std::string_view room;
    std::string_view headers;  ///< separated by spaces; relative to the room
};

inline constexpr std::array<PublicHeaders, 4> public_headers{
    {{"gltf", "load.h report.h camera_json.h asset_files.h"},
     {"crosscheck",
      "budget.h check_scene.h report_image.h report_json.h report_table.h truth.h box_tree.h "
      "shape_side.h"},
     {"explain", "explain_pixel.h report_json.h report_svg.h report_text.h"},
     {"bench",
      "asset_files.h machine.h measure_load.h measure_view.h report.h report_json.h "
      "report_svg.h report_table.h compare.h measure_standard.h standard_report.h"}}};

/// Known breaches of a rule, to be mended: "file: what". To be emptied, not filled.
inline constexpr std::array<std::string_view, 2> not_yet_mended{
    "gltf/parse/model.cpp: `bool keep_image`",  // tinygltf calls it so
    "surface/texture_record.h: `constexpr uint32_t pack_sampler`"};

/// Headers of the operating system and the C library: every room may include them.
inline constexpr std::array<std::string_view, 20> system_headers{
    "dirent.h", "dlfcn.h",   "errno.h",   "fnmatch.h", "fcntl.h", "glob.h",   "linux/",
    "malloc.h", "poll.h",    "pthread.h", "pwd.h",     "sched.h", "signal.h", "spawn.h",
    "stdlib.h", "strings.h", "sys/",      "termios.h", "time.h",  "unistd.h"};

inline std::optional<size_t> room_number(std::string_view room) {
    for (size_t i = 0; i < rooms.size(); ++i) {
        if (rooms[i] == room) return i;
    }
    return std::nullopt;
}

inline bool has_word(std::string_view words, std::string_view word) {
    return join({" ", words, " "}).find(join({" ", word, " "})) != std::string::npos;
}

/// "file:line: text" for each broken rule; empty is good.
using Problems = std::vector<std::string>;

inline std::string problem(std::string_view file,
                           size_t line,
                           std::initializer_list<std::string_view> text) {
    return join({file, ":", std::to_string(line), ": ", join(text)});
}

inline std::optional<std::string> check_public(const Include& include, std::string_view room) {
    for (const PublicHeaders& inside : public_headers) {
        if (inside.room == room || !include.path.starts_with(join({inside.room, "/"}))) continue;
        if (has_word(inside.headers, include.path.substr(inside.room.size() + 1))) continue;
        return join({"\"", include.path, "\" is inside its room, which offers ", inside.headers});
    }
    return std::nullopt;
}

inline std::optional<std::string> check_quoted(const Include& include, std::string_view room) {
    const std::string other = include.path.substr(0, include.path.find('/'));
    const std::optional<size_t> theirs = room_number(other);
    if (!theirs || other == include.path) {
        return join({"\"", include.path, "\" does not begin with a room: write \"room/file.h\""});
    }
    if (*theirs <= room_number(room).value_or(0)) return check_public(include, room);
    return join({room, " may not include ", other, ": that room comes later"});
}

inline std::optional<std::string> check_angled(const Include& include, std::string_view room) {
    for (const Owner& owner : owners) {
        if (!include.path.starts_with(owner.prefix)) continue;
        if (has_word(owner.rooms, room)) return std::nullopt;
        return join({"<", include.path, "> belongs to ", owner.rooms, ", not to ", room});
    }
    for (const std::string_view prefix : system_headers) {
        if (include.path.starts_with(prefix)) return std::nullopt;
    }
    if (include.path.find_first_of("/.") == std::string::npos) return std::nullopt;  // <vector>
    return join({"<", include.path, "> has no owner: add its library to tests/layout/rules.h"});
}

/// Rules about #include for a file in src/. `file` is relative to src: "room/name.h".
inline Problems check_includes(std::string_view file, std::string_view text) {
    const std::string_view room = file.substr(0, file.find('/'));
    if (!room_number(room)) {
        return {problem(file, 1, {"lies in no room; src/ holds rooms only"})};
    }
    Problems problems;
    for (const Include& include : find_includes(text)) {
        const auto found =
            include.quoted ? check_quoted(include, room) : check_angled(include, room);
        if (found) problems.push_back(problem(file, include.line, {*found}));
    }
    return problems;
}

/// Line number of the first line that is neither empty nor a comment; 0 if there is none.
inline size_t first_code_line(const std::vector<std::string>& lines) {
    for (size_t i = 0; i < lines.size(); ++i) {
        if (!lines[i].empty() && !lines[i].starts_with("//")) return i + 1;
    }
    return 0;
}

/// Line 1 `// path - purpose.`, line 2 SPDX, both within 100 columns; headers then begin with
/// `#pragma once`, below more comments if there are any.
inline Problems check_head(std::string_view file, std::string_view text) {
    Problems problems;
    const std::vector<std::string> lines = split_lines(text);
    const std::string expected = join({"// ", file, " - "});
    if (lines.empty() || !lines[0].starts_with(expected) || !lines[0].ends_with(".")) {
        problems.push_back(problem(file, 1, {"write `", expected, "purpose in one sentence.`"}));
    } else if (lines[0].size() > max_columns) {
        problems.push_back(
            problem(file, 1, {"say it within ", std::to_string(max_columns), " columns"}));
    }
    if (lines.size() < 2 || lines[1] != "// SPDX-License-Identifier: Apache-2.0") {
        problems.push_back(problem(file, 2, {"write `// SPDX-License-Identifier: Apache-2.0`"}));
    }
    const size_t code = first_code_line(lines);
    if (file.ends_with(".h") && (code == 0 || lines[code - 1] != "#pragma once")) {
        problems.push_back(problem(file, code, {"write `#pragma once` before any other code"}));
    }
    return problems;
}

/// What a reader counts as columns: bytes that begin a character of UTF-8.
inline size_t columns(std::string_view line) {
    return static_cast<size_t>(std::count_if(line.begin(), line.end(), [](char c) {
        return (static_cast<unsigned>(c) & 0xC0U) != 0x80;
    }));
}

/// Lines of at most 100 columns.
inline Problems check_columns(std::string_view file, std::string_view text) {
    Problems problems;
    const std::vector<std::string> lines = split_lines(text);
    for (size_t i = 0; i < lines.size(); ++i) {
        if (columns(lines[i]) <= max_columns) continue;
        problems.push_back(
            problem(file, i + 1, {"the line has ", std::to_string(columns(lines[i])), " columns"}));
    }
    return problems;
}

/// Functions that take at most 5 parameters; more become a struct.
inline Problems check_parameters(std::string_view file, std::string_view text) {
    Problems problems;
    for (const Function& function : find_functions(text).functions) {
        if (function.parameters <= max_parameters) continue;
        problems.push_back(problem(
            file,
            function.first_line,
            {"`", function.name, "` has ", std::to_string(function.parameters), " parameters"}));
    }
    return problems;
}

/// Files of at most 500 lines, functions of at most 60.
inline Problems check_sizes(std::string_view file, std::string_view text) {
    Problems problems;
    const size_t lines = split_lines(text).size();
    const auto too_long = [&](size_t line, std::string_view what, size_t count, size_t most) {
        problems.push_back(problem(file,
                                   line,
                                   {what,
                                    " has ",
                                    std::to_string(count),
                                    " lines; at most ",
                                    std::to_string(most),
                                    " are allowed"}));
    };
    if (lines > max_file_lines) too_long(lines, "the file", lines, max_file_lines);
    const FunctionList found = find_functions(text);
    if (!found.balanced) {
        problems.push_back(problem(file,
                                   lines,
                                   {"braces do not balance outside of preprocessor lines, so "
                                    "functions cannot be measured"}));
    }
    for (const Function& function : found.functions) {
        if (function.lines() <= max_function_lines) continue;
        too_long(function.first_line,
                 join({"`", function.name, "`"}),
                 function.lines(),
                 max_function_lines);
    }
    return problems;
}

}  // namespace obscura::layout
