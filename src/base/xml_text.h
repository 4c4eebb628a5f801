// base/xml_text.h - text as XML takes it: for drawings in SVG.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace obscura {

/// For elements and for attributes in double quotes: &, <, > and " become entities, control
/// characters blanks.
std::string escape_xml(std::string_view text);

}  // namespace obscura
