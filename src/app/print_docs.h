// app/print_docs.h - the hidden subcommand `obscura print-docs`: what is generated from the tables.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/command.h"

namespace obscura {

struct PrintDocsArguments {
    std::string kind;
    OptionText output;
};

/// The subcommand; it tells of all commands that `program` has by now. Parsing fills `arguments`.
Command print_docs_command(PrintDocsArguments& arguments, const Program& program);

}  // namespace obscura
