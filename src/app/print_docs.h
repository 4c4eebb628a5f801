// app/print_docs.h - the hidden subcommand `obscura print-docs`: texts from the tables.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/command.h"

namespace obscura::app {

struct PrintDocsArguments {
    std::string kind;
    OptionText output;
};

/// The subcommand; it covers all commands in `program` so far. Parsing fills `arguments`.
Command print_docs_command(PrintDocsArguments& arguments, const Program& program);

}  // namespace obscura::app
