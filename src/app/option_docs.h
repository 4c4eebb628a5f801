// app/option_docs.h - what the tables of options say as man page and as the tables of docs/cli.md.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/command.h"
#include "base/error.h"

#include <string>

namespace obscura {

/// The manual page obscura(1), for man.
std::string man_page(const Program& program);

/// The table of one command's options; those that are exactly another's are only named.
std::string markdown_table(const Program& program, const Command& command);

/// A document whose tables, between "<!-- options of COMMAND -->" and "<!-- end of options -->",
/// are made anew.
///
/// Errors  65 E-DOCS-MARK a mark without its end, or of no command
Result<std::string> with_markdown_tables(const Program& program, const std::string& document);

}  // namespace obscura
