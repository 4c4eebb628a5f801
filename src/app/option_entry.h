// app/option_entry.h - entries of option tables: names, values, targets, checks.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"

#include <array>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace obscura::app {

using OptionText = std::optional<std::string>;

/// The description of an option for parser, messages, help, man page, completion and docs/cli.md.
struct OptionInfo {
    const char* name = "";      ///< "--size", "-o,--output"; without dashes it is positional
    const char* argument = "";  ///< stands for the value: "WxH"; "": a flag or positional;
                                ///< "[=FILE]": a flag that may have a value, else it is "true"
    const char* help = "";      ///< sentences; a colon at the end: the names of `reader` follow
    struct {
        double low = 0, high = 0;
    } range = {};               ///< of numbers, inclusive
    double scale = 1;           ///< from the written number to the stored one
    const char* accepted = "";  ///< in messages: the form of a list of numbers
    const char* fallback = "";  ///< the default in words; "": its target's first value
    const char* files = "";     ///< completion: "*" files, "/" folders, else endings: "exr png"
    std::array<const char*, 4> excludes = {};  ///< may not be given beside it
    std::array<const char*, 2> needs = {};     ///< one must be given: "--sensor", "--integrator ao"
    std::string (*prints)() =
        nullptr;  ///< of a flag: the command prints this and does nothing else
};

/// E-USAGE-CONFLICT: options that do not go together.
///
/// In      where: the option, or what it names
tl::unexpected<Error> conflict(const std::string& where, const std::string& message);

/// "--output" of "-o,--output".
std::string long_name(const OptionInfo& info);

/// True for "--checkpoint" and "--checkpoint=FILE".
bool has_optional_value(const OptionInfo& info);

/// Where the text of an option is stored; unchanged when the option is not given.
using OptionTarget = std::variant<OptionText*, bool*, std::vector<std::string>*, std::string*>;

/// How texts of an option become values of a request.
template <typename Request>
struct OptionReader {
    /// Null: the request parses the text itself, because it needs more than the text.
    Result<void> (*read)(const OptionInfo& info,
                         const std::string& text,
                         Request& request) = nullptr;
    /// The request's present value as text; null or "": there is none to show.
    std::string (*show)(const OptionInfo& info, const Request& request) = nullptr;
    std::vector<std::string> (*names)() = nullptr;  ///< all that is accepted, or may be
};

/// One entry of a table.
///
/// To add an option: an entry in the table of its command (render_options.cpp and so on), a member
/// for its text in the arguments that the entry names, a member for its value in the request; then
/// use the value, and test it in tests/app or tests/cli. Parser, checks, --help, --config, man page
/// and completion use the entry; `obscura print-docs markdown -o docs/cli.md` updates the manual.
/// For the library, a member in include/obscura/ and its check in session/library_request.cpp.
template <typename Arguments, typename Request>
struct OptionEntry {
    OptionInfo info;
    OptionTarget (*target)(Arguments& arguments);
    OptionReader<Request> reader = {};
};

/// Entries under one heading of the help.
template <typename Arguments, typename Request>
struct OptionGroup {
    const char* heading;
    std::span<const OptionEntry<Arguments, Request>> entries;
};

/// An entry bound to the texts that parsing fills, with its default as a text.
struct BoundOption {
    OptionInfo info;
    const char* heading;
    OptionTarget target;
    std::string fallback = {};
    std::vector<std::string> names = {};
};

/// True when the option stood on the command line, or in the file of --config.
bool is_given(const BoundOption& option);

/// Its texts: none, one, or those of a repeatable option; an empty one for a flag.
std::vector<std::string> given_texts(const OptionTarget& target);

/// What any reader of `help` needs: the sentences, names, and range.
std::string full_help(const BoundOption& option);

/// Binds an entry; its default is that of an untouched request.
template <typename Arguments, typename Request>
BoundOption bind(const OptionEntry<Arguments, Request>& entry,
                 Arguments& arguments,
                 const char* heading) {
    BoundOption out{entry.info, heading, entry.target(arguments), entry.info.fallback, {}};
    if (entry.reader.names) out.names = entry.reader.names();
    if (out.fallback.empty() && entry.reader.show)
        out.fallback = entry.reader.show(entry.info, Request{});
    return out;
}

/// Binds all entries of some groups.
template <typename Arguments, typename Request>
std::vector<BoundOption> bind_all(std::span<const OptionGroup<Arguments, Request>> groups,
                                  Arguments& arguments) {
    std::vector<BoundOption> out;
    for (const auto& group : groups) {
        for (const auto& entry : group.entries)
            out.push_back(bind(entry, arguments, group.heading));
    }
    return out;
}

/// Reads every option that was given, in the order of the table.
///
/// Errors  that of the first refused option
template <typename Arguments, typename Request>
Result<void> read_options(std::span<const OptionGroup<Arguments, Request>> groups,
                          Arguments& arguments,
                          Request& request) {
    for (const auto& group : groups) {
        for (const auto& entry : group.entries) {
            if (!entry.reader.read) continue;
            for (const std::string& text : given_texts(entry.target(arguments))) {
                if (auto read = entry.reader.read(entry.info, text, request); !read) return read;
            }
        }
    }
    return {};
}

/// Checks which options exclude or need each other.
///
/// Errors  64 E-USAGE-CONFLICT
Result<void> check_combinations(std::span<const BoundOption> options);

}  // namespace obscura::app
