// app/option_row.h - an option is a row: what it is called, what it takes, where it goes.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"

#include <array>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace obscura {

using OptionText = std::optional<std::string>;

/// What is said of an option, to the parser, in messages, help, man page, completion and
/// docs/cli.md.
struct OptionInfo {
    const char* name = "";      ///< "--size", "-o,--output"; without dashes it stands by its place
    const char* argument = "";  ///< stands for the value: "WxH"; "": a flag, or what has a place
    const char* help = "";  ///< in sentences; behind a colon at its end come the names of `reader`
    struct {
        double low = 0, high = 0;
    } range = {};               ///< of numbers, inclusive
    double scale = 1;           ///< from the number that is written to the one that is kept
    const char* accepted = "";  ///< in messages: the form of a list of numbers
    const char* fallback = "";  ///< what holds without it, in words; "": its target's first value
    const char* files = "";     ///< completion: "*" files, "/" folders, else endings: "exr png"
    std::array<const char*, 4> excludes = {};  ///< may not be given beside it
    std::array<const char*, 2> needs = {};  ///< one of them is given: "--sensor", "--integrator ao"
};

/// "--output" of "-o,--output".
std::string long_name(const OptionInfo& info);

/// Where the text of an option is put; what is not given stays as it is.
using OptionTarget = std::variant<OptionText*, bool*, std::vector<std::string>*, std::string*>;

/// How texts of an option become values of a request.
template <typename Request>
struct OptionReader {
    /// Null: the request reads the text itself, when it knows more.
    Result<void> (*read)(const OptionInfo& info,
                         const std::string& text,
                         Request& request) = nullptr;
    /// The value that a request has, as a text; null or "": there is none to show.
    std::string (*show)(const OptionInfo& info, const Request& request) = nullptr;
    std::vector<std::string> (*names)() = nullptr;  ///< all that is accepted, or may be
};

/// One row of a table.
///
/// To add an option: a row in the table of its command (render_options.cpp and so on), a member for
/// its text in the arguments that the row names, a member for its value in the request; then use
/// the value, and test it in tests/app or tests/cli. Parser, checks, --help, --config, man page and
/// completion know it by the row; `obscura print-docs markdown -o docs/cli.md` tells the manual.
template <typename Arguments, typename Request>
struct OptionRow {
    OptionInfo info;
    OptionTarget (*target)(Arguments& arguments);
    OptionReader<Request> reader = {};
};

/// Rows that stand under one heading in the help.
template <typename Arguments, typename Request>
struct OptionGroup {
    const char* heading;
    std::span<const OptionRow<Arguments, Request>> rows;
};

/// A row as a command has it: bound to the texts that parsing fills, with its default as a text.
struct BoundOption {
    OptionInfo info;
    const char* heading;
    OptionTarget target;
    std::string fallback = {};
    std::vector<std::string> names = {};
};

/// True when the option stood on the command line, or in the file of --config.
bool is_given(const BoundOption& option);

/// Its texts: none, one, or those of an option that may be repeated; of a flag an empty one.
std::vector<std::string> given_texts(const OptionTarget& target);

/// What all readers of `help` see: the sentences, names, and range.
std::string full_help(const BoundOption& option);

/// Binds a row; its default is the one that an untouched request has.
template <typename Arguments, typename Request>
BoundOption bind(const OptionRow<Arguments, Request>& row,
                 Arguments& arguments,
                 const char* heading) {
    BoundOption out{row.info, heading, row.target(arguments), row.info.fallback, {}};
    if (row.reader.names) out.names = row.reader.names();
    if (out.fallback.empty() && row.reader.show)
        out.fallback = row.reader.show(row.info, Request{});
    return out;
}

/// Binds all rows of some groups.
template <typename Arguments, typename Request>
std::vector<BoundOption> bind_all(std::span<const OptionGroup<Arguments, Request>> groups,
                                  Arguments& arguments) {
    std::vector<BoundOption> out;
    for (const auto& group : groups) {
        for (const auto& row : group.rows)
            out.push_back(bind(row, arguments, group.heading));
    }
    return out;
}

/// Reads every option that was given, in the order of the table.
///
/// Errors  that of the first which is refused
template <typename Arguments, typename Request>
Result<void> read_options(std::span<const OptionGroup<Arguments, Request>> groups,
                          Arguments& arguments,
                          Request& request) {
    for (const auto& group : groups) {
        for (const auto& row : group.rows) {
            if (!row.reader.read) continue;
            for (const std::string& text : given_texts(row.target(arguments))) {
                if (auto read = row.reader.read(row.info, text, request); !read) return read;
            }
        }
    }
    return {};
}

/// What options exclude and need.
///
/// Errors  64 E-USAGE-CONFLICT
Result<void> check_combinations(std::span<const BoundOption> options);

}  // namespace obscura
