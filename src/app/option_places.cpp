// app/option_places.cpp - where a job's file gives the options that an error names.
// SPDX-License-Identifier: Apache-2.0
#include "app/option_places.h"

#include "base/setting_names.h"

namespace obscura::app {

Error at_its_place(Error error, const OptionPlaces& places) {
    const std::string where = spell_settings(error.where, SettingNames::options);
    auto place = places.find(where);
    std::string what = where.starts_with("--") ? "" : where;
    if (place == places.end()) {
        // Some name the value, too: "--view Standard".
        const size_t space = where.find(' ');
        if (space == std::string::npos || !where.starts_with("--")) return error;
        place = places.find(where.substr(0, space));
        what = where.substr(space + 1);
    }
    if (place == places.end()) return error;
    if (!what.empty()) error.message = what + ": " + error.message;
    error.where = place->second;
    return error;
}

}  // namespace obscura::app
