// image/ocio_load.h - loads an OpenColorIO config, and finds names in it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/log.h"

#include <OpenColorIO/OpenColorIO.h>

#include <mutex>
#include <string>
#include <vector>

namespace obscura {

/// Redirects OpenColorIO's notes from standard error to our log while it exists. The library has
/// one log function for all threads, so these objects exclude each other.
class OcioNotesToLog {
public:
    OcioNotesToLog(Log& log, const std::string& where) : turn_(one_at_a_time) {
        OCIO_NAMESPACE::SetLoggingFunction([&log, where](const char* text) {
            std::string line = text;
            while (!line.empty() && line.back() == '\n')
                line.pop_back();
            if (!line.empty()) log.detail(where + ": " + line);
        });
    }
    ~OcioNotesToLog() { OCIO_NAMESPACE::ResetToDefaultLoggingFunction(); }
    OcioNotesToLog(const OcioNotesToLog&) = delete;
    OcioNotesToLog& operator=(const OcioNotesToLog&) = delete;

private:
    static inline std::recursive_mutex one_at_a_time;
    std::lock_guard<std::recursive_mutex> turn_;
};

/// A config with the name that messages use for it.
struct NamedConfig {
    OCIO_NAMESPACE::ConstConfigRcPtr config;
    std::string name;
    bool is_builtin = false;
};

/// Loads a file, else $OCIO, else the built-in config.
///
/// Errors  78 E-OCIO-FILE it cannot be read or defines no display
Result<NamedConfig> load_config(const std::string& ocio_file, Log& log);

/// The entry of `names` that equals `wanted`, else one that does regardless of case; "" for none.
std::string find_name(const std::vector<std::string>& names, const std::string& wanted);

/// "'a', 'b'".
std::string quoted_list(const std::vector<std::string>& names);

/// A config's name for scene-linear Rec.709, else its scene_linear role with a warning; "" if it
/// has neither.
std::string input_space(const NamedConfig& from, Log& log);

/// An error of the colour configuration.
tl::unexpected<Error> bad_configuration(const char* id,
                                        const std::string& where,
                                        std::string message);

}  // namespace obscura
