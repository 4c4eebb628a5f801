// app/program.h - the program `obscura`: finds the subcommand and runs it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace obscura::app {

/// Runs the command line; returns the exit code. Throws only std::bad_alloc and on bugs.
int run_program(int argc, char** argv);

}  // namespace obscura::app
