// app/completion_scripts.cpp - completion of commands, options and values for shells.
// SPDX-License-Identifier: Apache-2.0
#include "app/completion_scripts.h"

#include <algorithm>
#include <map>

namespace obscura::app {

namespace {

std::string joined(const std::vector<std::string>& words, const char* between) {
    std::string out;
    for (const std::string& word : words)
        out += (out.empty() ? "" : between) + word;
    return out;
}

bool has_place(const BoundOption& option) {
    return option.info.name[0] != '-';
}

/// The endings of the files that a command is given without an option's name.
std::string files_of(const Command& command) {
    for (const BoundOption& option : command.options)
        if (has_place(option)) return option.info.files;
    return {};
}

bool is_flag(const BoundOption& option) {
    return std::holds_alternative<bool*>(option.target) || has_optional_value(option.info);
}

/// "-o", "--output".
std::vector<std::string> names_of(const BoundOption& option) {
    const std::string names = option.info.name;
    const size_t comma = names.find(',');
    if (comma == std::string::npos) return {names};
    return {names.substr(0, comma), names.substr(comma + 1)};
}

/// The help in one line, up to its first full stop.
std::string short_help(const BoundOption& option) {
    constexpr size_t longest = 70;
    std::string text = option.info.help;
    text = text.substr(0, text.find(". "));
    if (!text.empty() && text.back() == ':') text.pop_back();
    return text.size() <= longest ? text : text.substr(0, text.rfind(' ', longest)) + " ...";
}

/// In single quotes, for all three shells; `special` gets a backslash.
std::string in_shell_quotes(const std::string& text, const std::string& special = "") {
    std::string out = "'";
    for (const char c : text) {
        if (special.find(c) != std::string::npos) out += '\\';
        out += c == '\'' ? "'\\''" : std::string(1, c);
    }
    return out + "'";
}

std::vector<const Command*> shown(const Program& program) {
    std::vector<const Command*> out;
    for (const Command& command : program.commands)
        if (!command.hidden) out.push_back(&command);
    return out;
}

/// The completion of an option's value in bash.
std::string bash_action(const BoundOption& option) {
    if (!option.names.empty())
        return "_obscura_words " + in_shell_quotes(joined(option.names, " "));
    if (*option.info.files) return "_obscura_files " + in_shell_quotes(option.info.files);
    return ":";
}

/// Files with one of the endings.
std::string zsh_files(std::string endings) {
    std::replace(endings.begin(), endings.end(), ' ', '|');
    return "_files -g \"*.(" + endings + ")(-.)\"";
}

/// The completion of an argument in zsh.
std::string zsh_action(const BoundOption& option) {
    const std::string files = option.info.files;
    if (!option.names.empty()) return "(" + joined(option.names, " ") + ")";
    if (files == "/") return "_files -/";
    if (files == "*") return "_files";
    return files.empty() ? " " : zsh_files(files);
}

std::string zsh_option(const BoundOption& option) {
    const std::string help = "[" + joined({short_help(option)}, "") + "]";
    const std::string argument =
        is_flag(option) ? "" : ":" + std::string(option.info.argument) + ":" + zsh_action(option);
    std::string text = in_shell_quotes(help.substr(1, help.size() - 2), "[]:\\");
    text = "'[" + text.substr(1, text.size() - 2) + "]" + in_shell_quotes(argument).substr(1);
    const bool many = std::holds_alternative<std::vector<std::string>*>(option.target);
    const std::vector<std::string> names = names_of(option);
    const std::string head = many ? "'*'" : "";
    return head + (names.size() > 1 ? "{" + joined(names, ",") + "}" : names[0]) + text;
}

std::string fish_option(const Command& command, const BoundOption& option) {
    std::string out =
        std::string("complete -c obscura -n '__fish_seen_subcommand_from ") + command.name + "'";
    for (const std::string& name : names_of(option))
        out += name[1] == '-' ? " -l " + name.substr(2) : " -s " + name.substr(1);
    const std::string files = option.info.files;
    if (is_flag(option)) {
        out += "";
    } else if (!option.names.empty()) {
        out += " -x -a " + in_shell_quotes(joined(option.names, " "));
    } else if (files == "/") {
        out += " -x -a '(__fish_complete_directories)'";
    } else {
        out += files.empty() ? " -x" : " -r -F";
    }
    return out + " -d " + in_shell_quotes(short_help(option), "\\") + "\n";
}

constexpr const char* bash_functions = R"(
_obscura_words() {
    COMPREPLY=($(compgen -W "$1" -- "$word"))
}

# Folders, and files with one of the endings; "/" is folders only, "*" every file.
_obscura_files() {
    local name ending
    compopt -o filenames 2>/dev/null
    while IFS= read -r name; do
        if [[ -d $name || $1 == '*' ]]; then
            COMPREPLY+=("$name")
            continue
        fi
        for ending in ${1//\//}; do
            [[ ${name,,} == *.$ending ]] && COMPREPLY+=("$name")
        done
    done < <(compgen -f -- "$word")
}
)";

}  // namespace

std::string bash_completion(const Program& program) {
    std::vector<std::string> commands;
    std::string options;
    std::map<std::string, std::vector<std::string>> places;  // by what is done there
    for (const Command* command : shown(program)) {
        commands.emplace_back(command->name);
        std::string all = "-h --help";
        for (const BoundOption& option : command->options) {
            if (has_place(option)) continue;
            for (const std::string& name : names_of(option)) {
                all += " " + name;
                if (is_flag(option)) continue;
                places[bash_action(option)].push_back(
                    in_shell_quotes(command->name + (" " + name)));
            }
        }
        options += std::string("    ") + command->name + ") options=" + in_shell_quotes(all) +
                   " files=" + in_shell_quotes(files_of(*command)) + " ;;\n";
    }
    std::string out = "# bash completion for obscura; generated by `obscura print-docs bash`.\n";
    out += bash_functions;
    out += R"(
_obscura() {
    local word=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} command=
    local options files i
    COMPREPLY=()
    for ((i = 1; i < COMP_CWORD; i++)); do
        case ${COMP_WORDS[i]} in
        )" +
           joined(commands, " | ") +
           R"()
            command=${COMP_WORDS[i]}
            break
            ;;
        esac
    done
    case $command in
    '')
        _obscura_words ')" +
           joined(commands, " ") + R"( --help --version'
        return
        ;;
)" + options +
           R"(    esac
    case "$command $previous" in
)";
    for (const auto& [action, names] : places)
        out += "    " + joined(names, " | ") + ")\n        " + action +
               "\n        return\n        ;;\n";
    return out + R"(    esac
    if [[ $word == -* ]]; then
        _obscura_words "$options"
    else
        _obscura_files "$files"
    fi
}

complete -F _obscura obscura
)";
}

std::string zsh_completion(const Program& program) {
    std::string commands;
    std::string cases;
    for (const Command* command : shown(program)) {
        commands += "            " +
                    in_shell_quotes(std::string(command->name) + ":" + command->summary) + "\n";
        cases += std::string("        ") + command->name + ")\n            _arguments \\\n";
        for (const BoundOption& option : command->options) {
            if (!has_place(option)) cases += "                " + zsh_option(option) + " \\\n";
        }
        cases +=
            "                '(- *)'{-h,--help}'[Print this help and exit]' \\\n"
            "                '*:file:" +
            zsh_files(files_of(*command)) + "'\n            ;;\n";
    }
    return "#compdef obscura\n# Generated by `obscura print-docs zsh`.\n\n"
           "_obscura() {\n"
           "    local curcontext=\"$curcontext\" state line\n"
           "    local -a commands\n"
           "    typeset -A opt_args\n"
           "    _arguments -C '(- *)--version[Print versions and exit]' \\\n"
           "        '(- *)'{-h,--help}'[Print this help and exit]' \\\n"
           "        '1:command:->command' '*::argument:->argument'\n"
           "    case $state in\n"
           "    command)\n"
           "        commands=(\n" +
           commands +
           "        )\n"
           "        _describe command commands\n"
           "        ;;\n"
           "    argument)\n"
           "        case $words[1] in\n" +
           cases +
           "        esac\n"
           "        ;;\n"
           "    esac\n"
           "}\n\n"
           "_obscura \"$@\"\n";
}

std::string fish_completion(const Program& program) {
    std::string out =
        "# fish completion for obscura; generated by `obscura print-docs fish`.\n"
        "complete -c obscura -n __fish_use_subcommand -f\n"
        "complete -c obscura -s h -l help -d 'Print this help and exit'\n"
        "complete -c obscura -n __fish_use_subcommand -l version -d 'Print versions "
        "and exit'\n";
    for (const Command* command : shown(program)) {
        out += std::string("complete -c obscura -n __fish_use_subcommand -a ") + command->name +
               " -d " + in_shell_quotes(command->summary, "\\") + "\n";
    }
    for (const Command* command : shown(program)) {
        for (const BoundOption& option : command->options)
            if (!has_place(option)) out += fish_option(*command, option);
    }
    return out;
}

}  // namespace obscura::app
