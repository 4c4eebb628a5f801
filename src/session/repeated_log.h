// session/repeated_log.h - logs of further images, which pass on new warnings only.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/log.h"

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace obscura {

/// Of the messages of further images, only new warnings go to the first one's log.
class RepeatedLog {
public:
    /// names: as `log` spells them
    RepeatedLog(Log& log, SettingNames names) : log_(log), names_(names) {}

    /// The log of the next image.
    Log& begin() {
        told_ = log_.warnings();
        const auto pass_on = [this](const LogMessage& message) {
            const std::string line = std::string(message.where) + ": " + std::string(message.text);
            const bool known = std::find(told_.begin(), told_.end(), line) != told_.end();
            if (message.is_warning && !known) log_.warn(message.where, message.text);
        };
        return own_.emplace(Verbosity::normal, pass_on, names_);
    }

private:
    Log& log_;
    SettingNames names_;
    std::vector<std::string> told_;
    std::optional<Log> own_;
};

}  // namespace obscura
