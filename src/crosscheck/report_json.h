// crosscheck/report_json.h - what a cross-check found, for programs.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "crosscheck/check_scene.h"

#include <string>
#include <vector>

namespace obscura {

/// One JSON object; docs/cli.md explains the keys.
std::string crosscheck_json(const std::vector<CheckedScene>& scenes,
                            const std::vector<std::string>& warnings);

}  // namespace obscura
