// app/option_docs.h - writes the tables of options as a man page and for docs/cli.md.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/command.h"
#include "base/error.h"

#include <string>

namespace obscura::app {

/// The manual page obscura(1), for man.
std::string man_page(const Program& program);

/// The table of one command's options; options equal to another's are only named.
std::string markdown_table(const Program& program, const Command& command);

/// A document with its tables, between "<!-- options of COMMAND -->" and "<!-- end of options -->",
/// made anew.
///
/// Errors  65 E-DOCS-MARK a mark without its end, or of no command
Result<std::string> with_markdown_tables(const Program& program, const std::string& document);

}  // namespace obscura::app
