// crosscheck/report_table.h - the results of a cross-check as tables for people.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "crosscheck/check_scene.h"

#include <string>

namespace obscura::crosscheck {

std::string check_table(const CheckedScene& scene);

/// "t=1.25 instance=-1 primitive=0 row=7", "miss" or "occluded".
std::string describe(const Answer& answer);

/// "agree"; "edge, 0.5 ulp".
std::string describe(const Comparison& comparison);

/// The option that traces this one ray again.
std::string replay_option(const TrueRay& ray);

const char* verdict_name(Verdict verdict);

}  // namespace obscura::crosscheck
