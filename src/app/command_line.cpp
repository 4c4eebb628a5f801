// app/command_line.cpp - parses the command line into option texts; uses CLI11.
// SPDX-License-Identifier: Apache-2.0
#include "app/command_line.h"

#include "app/config_file.h"
#include "app/numbers.h"
#include "base/name_search.h"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <fmt/ranges.h>
#include <memory>
#include <optional>
#include <sstream>
#include <string_view>

namespace obscura::app {

namespace {

constexpr size_t names_width = 28;
constexpr size_t help_width = 62;

tl::unexpected<Error> usage(const std::string& where, const std::string& message) {
    return fail(ExitCode::usage, "E-USAGE", where, message);
}

/// Breaks a text between words into lines.
std::string wrapped(const std::string& text) {
    std::string out;
    size_t line = 0;
    for (size_t begin = 0; begin < text.size();) {
        const size_t end = std::min(text.find(' ', begin), text.size());
        const size_t length = end - begin;
        if (line > 0) out += line + 1 + length > help_width ? '\n' : ' ';
        line = line > 0 && line + 1 + length <= help_width ? line + 1 + length : length;
        out += text.substr(begin, length);
        begin = end + 1;
    }
    return out;
}

void declare(CLI::App& command, const BoundOption& option) {
    const OptionInfo& info = option.info;
    std::string help = full_help(option);
    if (!option.fallback.empty()) help += " [" + option.fallback + "]";
    help = wrapped(help);
    CLI::Option* declared = nullptr;
    if (has_optional_value(info)) {
        declared = command.add_flag(info.name, *std::get<OptionText*>(option.target), help);
    } else if (auto* const* text = std::get_if<OptionText*>(&option.target)) {
        const auto store = [target = *text](const std::string& given) { *target = given; };
        declared = command.add_option_function<std::string>(info.name, store, help);
    } else if (auto* const* flag = std::get_if<bool*>(&option.target)) {
        declared = command.add_flag(info.name, **flag, help);
    } else if (auto* const* list = std::get_if<std::vector<std::string>*>(&option.target)) {
        declared = command.add_option(info.name, **list, help);
        if (info.name[0] == '-') declared->allow_extra_args(false);
    } else {
        declared = command.add_option(info.name, *std::get<std::string*>(option.target), help);
        declared->required();
    }
    if (!std::holds_alternative<bool*>(option.target)) declared->type_name(info.argument);
    if (*option.heading) declared->group(option.heading);
}

/// The option that has too few or too many values; "" for other complaints. The parser's text
/// begins with its name.
std::string option_of(const CLI::ParseError& error) {
    const std::string text = error.what();
    const bool counts = error.get_name() == "ArgumentMismatch";
    return counts ? text.substr(0, text.find_first_of(": ")) : "";
}

/// The flag that was given a value; "" for other complaints.
std::string flag_with_value(const CLI::ParseError& error) {
    const std::string text = error.what();
    const size_t name = text.find("--");
    const bool has_value = error.get_name() == "ConversionError" && name != std::string::npos;
    return has_value ? text.substr(name, text.find_first_of(" =", name) - name) : "";
}

/// The commands but `render`, with commas and an "or" between them.
std::string names_of_others(const Program& program) {
    std::vector<std::string> names;
    for (const Command& command : program.commands) {
        if (!command.hidden && command.name != std::string_view("render"))
            names.push_back(fmt::format("`{}`", command.name));
    }
    const std::string last = names.back();
    names.pop_back();
    return fmt::format("{} or {}", fmt::join(names, ", "), last);
}

/// Rewords a parser's complaint about the command line.
tl::unexpected<Error> worded(const CLI::App& app,
                             const Program& program,
                             const CLI::ParseError& error) {
    const std::vector<CLI::App*> chosen = app.get_subcommands();
    if (chosen.empty()) {
        const std::vector<std::string> extras = app.remaining();
        const std::string got =
            extras.empty() ? "no command was given" : in_quotes(extras.front()) + " is no command";
        return usage("command-line",
                     got + "; expected `obscura render SCENE`, a scene alone (.gltf or .glb), or " +
                         names_of_others(program) + "; see `obscura --help`");
    }
    const std::string name = chosen.front()->get_name();
    const std::string hint = "; `obscura " + name + " --help` lists what is accepted";
    const std::vector<std::string> extras = chosen.front()->remaining();
    if (extras.empty()) {
        const std::string flag = flag_with_value(error);
        if (!flag.empty()) return usage(flag, "it is given or left out, and takes no value" + hint);
        const std::string option = option_of(error);
        if (option.empty()) return usage("command-line", error.what() + hint);
        return usage(option, "expected the option once, with one value" + hint);
    }
    const std::string& first = extras.front();
    if (first.size() > 1 && first[0] == '-') {
        const auto is_chosen = [&](const Command& command) { return command.name == name; };
        const auto command =
            std::find_if(program.commands.begin(), program.commands.end(), is_chosen);
        const std::string near = nearest_option(*command, first.substr(0, first.find('=')));
        return usage(first,
                     "there is no such option" +
                         (near.empty() ? near : " (did you mean " + near + "?)") + hint);
    }
    return usage("command-line",
                 in_quotes(first) + " is one argument too many" + commas_hint(first) + hint);
}

/// A file's items, read by CLI11 as INI and TOML. Comments are removed before, because CLI11 would
/// find them inside names, too.
Result<void> read_config(const Command& command, const Program& program) {
    const auto config =
        std::find_if(command.options.begin(), command.options.end(), [](const BoundOption& option) {
            return std::string(option.info.name) == "--config";
        });
    if (config == command.options.end() || !is_given(*config)) return {};
    const std::string file = given_texts(config->target).front();
    const Result<std::string> text = read_config_text(file);
    if (!text) return fail(text.error());
    std::vector<ConfigItem> items;
    try {
        std::istringstream stream(*text);
        for (const CLI::ConfigItem& item : CLI::ConfigBase().comment('\0')->from_config(stream)) {
            if (item.name != "++" && item.name != "--") {
                items.push_back({item.parents, item.name, item.inputs});
            }
        }
    } catch (const CLI::Error& error) {
        return usage(file, std::string("it is neither INI nor TOML: ") + error.what());
    }
    return apply_config(file, items, command, program);
}

/// What an option prints that stands for the whole command; nothing if none was given.
std::optional<std::string> printed_text(const Program& program) {
    for (const Command& command : program.commands) {
        for (const BoundOption& option : command.options) {
            if (option.info.prints != nullptr && is_given(option)) return option.info.prints();
        }
    }
    return {};
}

}  // namespace

std::string commas_hint(const std::string& word) {
    const bool is_number = word.find_first_not_of("0123456789.+-eE") == std::string::npos;
    return is_number ? "; an option's numbers have commas between them, as in --eye 1,2,3" : "";
}

std::string nearest_option(const Command& command, const std::string& typed) {
    std::string best;
    size_t best_distance = 3;
    for (const BoundOption& option : command.options) {
        const std::string name = long_name(option.info);
        const size_t distance = edit_distance(typed, name);
        if (name[0] != '-' || distance >= best_distance) continue;
        best_distance = distance;
        best = name;
    }
    return best;
}

Result<CommandLine> parse_command_line(const Program& program, int argc, const char* const* argv) {
    CLI::App app(program.summary, program.name);
    app.set_version_flag("--version", program.version, "Print versions and exit");
    app.set_help_flag("-h,--help", "Print this help and exit");
    app.require_subcommand(1);
    app.footer(program.notes);
    std::vector<CLI::App*> declared;
    for (const Command& command : program.commands) {
        CLI::App* sub = app.add_subcommand(command.name, command.summary);
        if (command.hidden) sub->group("");
        for (const BoundOption& option : command.options)
            declare(*sub, option);
        sub->footer(command.notes);
        sub->get_formatter()->column_width(names_width);
        declared.push_back(sub);
    }
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        return CommandLine{nullptr, app.help()};
    } catch (const CLI::CallForVersion&) {
        return CommandLine{nullptr, program.version + "\n"};
    } catch (const CLI::RequiredError& error) {
        if (const auto text = printed_text(program)) return CommandLine{nullptr, *text};
        return worded(app, program, error);
    } catch (const CLI::ParseError& error) {
        return worded(app, program, error);
    }
    if (const auto text = printed_text(program)) return CommandLine{nullptr, *text};
    const auto parsed = std::find_if(
        declared.begin(), declared.end(), [](const CLI::App* sub) { return sub->parsed(); });
    const Command& command =
        program.commands[static_cast<size_t>(std::distance(declared.begin(), parsed))];
    if (auto read = read_config(command, program); !read) return fail(read.error());
    return CommandLine{&command, ""};
}

}  // namespace obscura::app
