// bench/machine_json.h - what all JSON reports of a bench have: machine, figures, changes.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/json/json.h"
#include "bench/compare.h"
#include "bench/report.h"

#include <vector>

namespace obscura::bench {

Json machine_json(const Machine& machine);

/// What read_old_report reads.
Json figures_json(const std::vector<Figure>& figures);

Json changes_json(const std::vector<Change>& changes);

}  // namespace obscura::bench
