// app/print_docs.cpp - the hidden subcommand print-docs: texts generated from the tables.
// SPDX-License-Identifier: Apache-2.0
#include "app/print_docs.h"

#include "app/completion_scripts.h"
#include "app/option_docs.h"
#include "app/option_readers.h"
#include "app/outcome.h"
#include "base/atomic_file.h"

#include <fstream>
#include <span>
#include <sstream>

namespace obscura::app {

namespace {

using A = PrintDocsArguments;

/// One kind of text, and how it is made.
struct Kind {
    const char* name;
    std::string (*value)(const Program& program);
};

std::string all_tables(const Program& program) {
    std::string out;
    for (const Command& command : program.commands) {
        if (command.hidden) continue;
        out += std::string("## ") + command.name + "\n\n" + markdown_table(program, command) + "\n";
    }
    return out;
}

constexpr std::array<Kind, 5> kinds = {{{"man", man_page},
                                        {"bash", bash_completion},
                                        {"zsh", zsh_completion},
                                        {"fish", fish_completion},
                                        {"markdown", all_tables}}};

constexpr OptionInfo kind_option = {
    .name = "KIND", .help = "man, bash, zsh, fish, or markdown: the tables of docs/cli.md"};
constexpr OptionInfo output_option = {
    .name = "-o,--output",
    .argument = "FILE",
    .help = "Where it is written; of markdown the tables in that file are replaced",
    .fallback = "standard output",
    .files = "*"};

Result<void> print(const Program& program, const A& arguments) {
    const auto make = choose_option(arguments.kind, "KIND", kinds);
    if (!make) return fail(make.error());
    Result<std::string> text = (*make)(program);
    if (!arguments.output) return print_output(*text);
    if (*make == all_tables) {
        std::ifstream stream(*arguments.output);
        std::stringstream document;
        document << stream.rdbuf();
        text = with_markdown_tables(program, document.str());
        if (!text) return fail(text.error());
    }
    return write_file_atomically(*arguments.output, std::as_bytes(std::span(*text)));
}

}  // namespace

Command print_docs_command(PrintDocsArguments& arguments, const Program& program) {
    Command command{"print-docs", "Print the man page, completions or tables of options", ""};
    command.hidden = true;
    command.options = {{kind_option, "", &arguments.kind}, {output_option, "", &arguments.output}};
    command.run = [&arguments, program] {
        const Log log(Verbosity::quiet);
        const Result<void> done = print(program, arguments);
        return done ? report_success("print-docs", log) : report_failure(done.error(), log);
    };
    return command;
}

}  // namespace obscura::app
