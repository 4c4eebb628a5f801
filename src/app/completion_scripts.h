// app/completion_scripts.h - what shells need to complete commands, options and their values.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/command.h"

#include <string>

namespace obscura {

/// For share/bash-completion/completions/obscura.
std::string bash_completion(const Program& program);

/// For share/zsh/site-functions/_obscura.
std::string zsh_completion(const Program& program);

/// For share/fish/vendor_completions.d/obscura.fish.
std::string fish_completion(const Program& program);

}  // namespace obscura
