// app/explain_report.h - what `obscura info --explain` says: the fate of every part's wishes.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/asset_info.h"

#include <string>

namespace obscura {

/// For people: a part of the file a paragraph, what it asks for below it. Names are escaped.
std::string explain_table(const AssetInfo& info);

/// For scripts: one document; docs/cli.md explains the keys.
std::string explain_json(const AssetInfo& info);

}  // namespace obscura
