// app/completion_scripts.h - completion of commands, options and values for shells.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/command.h"

#include <string>

namespace obscura::app {

/// For share/bash-completion/completions/obscura.
std::string bash_completion(const Program& program);

/// For share/zsh/site-functions/_obscura.
std::string zsh_completion(const Program& program);

/// For share/fish/vendor_completions.d/obscura.fish.
std::string fish_completion(const Program& program);

}  // namespace obscura::app
