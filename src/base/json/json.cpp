// base/json/json.cpp - JSON values for reports, and their text.
// SPDX-License-Identifier: Apache-2.0
#include "base/json/json.h"

namespace obscura {

std::string json_document(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace obscura
