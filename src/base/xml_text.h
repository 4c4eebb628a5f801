// base/xml_text.h - escapes text for XML and HTML (drawings, pages).
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace obscura {

/// Escapes text for elements and for attributes in double quotes: &, <, > and " become entities,
/// control characters become blanks.
std::string escape_xml(std::string_view text);

}  // namespace obscura
