// app/config_file.cpp - reads the file of --config, whose options the command line overrides.
// SPDX-License-Identifier: Apache-2.0
#include "app/config_file.h"

#include "app/command_line.h"
#include "app/numbers.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

namespace obscura::app {

namespace {

bool is_blank(char c) {
    return c == ' ' || c == '\t';
}

std::string without_comment(const std::string& line) {
    char quote = 0;
    for (size_t i = 0; i < line.size(); ++i) {
        const char c = line[i];
        if (quote) {
            if (c == quote) quote = 0;
        } else if (c == '"' || c == '\'') {
            quote = c;
        } else if (c == '#' && (i == 0 || is_blank(line[i - 1]))) {
            return line.substr(0, i);
        }
    }
    return line;
}

/// The file of an item, for messages: "look.toml#render.spp".
std::string place_of(const std::string& file, const ConfigItem& item) {
    std::string place = file + "#";
    for (const std::string& part : item.section)
        place += part + ".";
    return place + item.key;
}

tl::unexpected<Error> refuse(const char* id, const std::string& where, const std::string& message) {
    return fail(ExitCode::usage, id, where, message);
}

/// The option that a key names; null: there is none.
const BoundOption* find_option(const Command& command, const std::string& key) {
    for (const BoundOption& option : command.options) {
        const std::string name = long_name(option.info);
        if (name != "--config" && name == "--" + key) return &option;
    }
    return nullptr;
}

tl::unexpected<Error> no_such_option(const Command& command,
                                     const std::string& key,
                                     const std::string& place) {
    const std::string near = nearest_option(command, "--" + key);
    const bool helps = !near.empty() && near != "--config";
    return refuse("E-CONFIG-KEY",
                  place,
                  in_quotes(key) + " is no option of `obscura " + command.name + "` for a file" +
                      (helps ? " (did you mean " + near.substr(2) + "?)" : ""));
}

/// True when one of the two excludes the other.
bool exclude(const OptionInfo& a, const OptionInfo& b) {
    const auto names = [](const OptionInfo& info, const OptionInfo& other) {
        return std::any_of(info.excludes.begin(), info.excludes.end(), [&](const char* name) {
            return name && name == long_name(other);
        });
    };
    return names(a, b) || names(b, a);
}

Result<void> set_flag(bool& flag, const std::string& text, const std::string& place) {
    if (text != "true" && text != "false") {
        return refuse("E-CONFIG-VALUE", place, in_quotes(text) + " is neither true nor false");
    }
    flag = text == "true";
    return {};
}

Result<void> set(const BoundOption& option, const ConfigItem& item, const std::string& place) {
    if (auto* const* list = std::get_if<std::vector<std::string>*>(&option.target)) {
        **list = item.values;
        return {};
    }
    std::string text;
    for (const std::string& value : item.values)
        text += (text.empty() ? "" : ",") + value;
    const bool takes_list = std::strchr(option.info.argument, ',') != nullptr;
    if (item.values.size() != 1 && !takes_list) {
        return refuse("E-CONFIG-VALUE",
                      place,
                      "expected one value; a text with blanks or commas stands in quotes");
    }
    if (auto* const* flag = std::get_if<bool*>(&option.target))
        return set_flag(**flag, text, place);
    if (auto* const* target = std::get_if<OptionText*>(&option.target)) **target = text;
    return {};
}

}  // namespace

BoundOption config_option(OptionText& target) {
    static constexpr OptionInfo info = {
        .name = "--config",
        .argument = "FILE",
        .help =
            "Read options from a TOML or INI file: spp = 64 below [render], or in front of all "
            "sections for every command. What stands on the command line goes before",
        .files = "toml ini"};
    return {info, "", &target};
}

Result<std::string> read_config_text(const std::string& file) {
    std::ifstream stream(file);
    std::string text;
    std::string line;
    std::error_code error;
    const bool folder = std::filesystem::is_directory(file, error);
    while (!folder && std::getline(stream, line))
        text += without_comment(line) + "\n";
    if (!folder && stream.eof()) return text;
    return fail(ExitCode::missing_scene,
                "E-CONFIG-MISSING",
                file,
                "the file of --config is missing or cannot be read");
}

Result<void> apply_config(const std::string& file,
                          const std::vector<ConfigItem>& items,
                          const Command& command,
                          const Program& program) {
    std::vector<const OptionInfo*> typed;
    for (const BoundOption& option : command.options) {
        if (is_given(option)) typed.push_back(&option.info);
    }
    const auto goes_before = [&](const OptionInfo& info) {
        return std::any_of(typed.begin(), typed.end(), [&](const OptionInfo* other) {
            return other == &info || exclude(*other, info);
        });
    };
    std::set<std::string> own;  // keys of the command's section
    for (const bool sections : {true, false}) {
        std::set<std::string> keys;
        for (const ConfigItem& item : items) {
            if (item.section.empty() == sections) continue;
            const std::string place = place_of(file, item);
            if (sections && (item.section.size() > 1 || item.section[0] != command.name)) {
                const bool known = std::any_of(
                    program.commands.begin(), program.commands.end(), [&](const Command& other) {
                        return item.section[0] == other.name;
                    });
                if (known && item.section.size() == 1) continue;
                return refuse("E-CONFIG-KEY", place, "its section is no command of obscura");
            }
            const BoundOption* option = find_option(command, item.key);
            if (!option) return no_such_option(command, item.key, place);
            if (!keys.insert(item.key).second) {
                return refuse("E-CONFIG-KEY", place, "the key is there twice");
            }
            if (own.contains(item.key) || goes_before(option->info)) continue;
            if (auto done = set(*option, item, place); !done) return done;
        }
        own = std::move(keys);
    }
    return {};
}

}  // namespace obscura::app
