// crosscheck/report_json.h - the results of a cross-check as JSON.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "crosscheck/check_scene.h"

#include <string>
#include <vector>

namespace obscura::crosscheck {

/// One JSON object; docs/cli.md explains the keys.
std::string crosscheck_json(const std::vector<CheckedScene>& scenes,
                            const std::vector<std::string>& warnings);

}  // namespace obscura::crosscheck
