// app/explain_report.h - `obscura info --explain`: the support of every feature in a file.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/asset_info.h"

#include <string>

namespace obscura::app {

/// For people: a paragraph for each part of the file, with its features. Names are escaped.
std::string explain_table(const AssetInfo& info);

/// For scripts: one document; docs/cli.md explains the keys.
std::string explain_json(const AssetInfo& info);

}  // namespace obscura::app
