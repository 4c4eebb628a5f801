// image/ocio_load.cpp - loads an OpenColorIO config, and finds names in it.
// SPDX-License-Identifier: Apache-2.0
#include "image/ocio_load.h"

#include "base/setting_names.h"
#include "base/text.h"
#include "image/ocio_config.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <utility>

namespace obscura {

namespace ocio = OCIO_NAMESPACE;

namespace {

constexpr std::uintmax_t largest_config_bytes = 64U << 20;

/// "" when `file` may be opened: not a pipe or device, which would block, and not absurdly large.
std::string why_unreadable(const std::string& file) {
    if (file.rfind("ocio://", 0) == 0) return {};  // a config inside the library, from 2.2 on
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    if (!std::filesystem::exists(status))
        return is_web_address(file) ? not_fetched : "there is no such file";
    if (!std::filesystem::is_regular_file(status)) return "this is not a regular file";
    const auto size = std::filesystem::file_size(file, error);
    if (!error && size > largest_config_bytes) return "larger than 64 MB";
    return {};
}

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    return text;
}

}  // namespace

tl::unexpected<Error> bad_configuration(const char* id,
                                        const std::string& where,
                                        std::string message) {
    std::replace(message.begin(), message.end(), '\n', ' ');  // of the parser of YAML
    return fail(ExitCode::configuration, id, where, std::move(message));
}

Result<NamedConfig> load_config(const std::string& ocio_file, Log& log) {
    const char* variable = std::getenv("OCIO");
    const bool from_option = !ocio_file.empty();
    const std::string file = from_option ? ocio_file : variable ? variable : "";
    if (file.empty()) {
        std::istringstream text(builtin_ocio_config);
        return NamedConfig{ocio::Config::CreateFromStream(text), "built-in OCIO config", true};
    }
    const std::string where = (from_option ? setting("ocio") : "$OCIO") + " " + file;
    const std::string expected = "; give an OpenColorIO config file (.ocio)";
    if (const std::string why = why_unreadable(file); !why.empty()) {
        return bad_configuration("E-OCIO-FILE", where, why + expected);
    }
    try {
        const OcioNotesToLog notes(log, where);
        ocio::ConstConfigRcPtr config = ocio::Config::CreateFromFile(file.c_str());
        if (config->getNumDisplays() == 0) {
            return bad_configuration("E-OCIO-FILE", where, "defines no display" + expected);
        }
        return NamedConfig{std::move(config), where, false};
    } catch (const std::exception& error) {
        return bad_configuration("E-OCIO-FILE", where, error.what() + expected);
    }
}

std::string find_name(const std::vector<std::string>& names, const std::string& wanted) {
    for (const std::string& name : names) {
        if (name == wanted) return name;
    }
    for (const std::string& name : names) {
        if (lower(name) == lower(wanted)) return name;
    }
    return {};
}

std::string quoted_list(const std::vector<std::string>& names) {
    std::string list;
    for (const std::string& name : names)
        list += (list.empty() ? "'" : ", '") + name + "'";
    return list;
}

std::string input_space(const NamedConfig& from, Log& log) {
    for (const char* name : {"lin_rec709_scene",
                             "Linear Rec.709 (sRGB)",
                             "lin_rec709",
                             "lin_rec709_srgb",
                             "Utility - Linear - Rec.709",
                             "Linear BT.709"}) {
        if (from.config->getColorSpace(name)) return name;
    }
    const ocio::ConstColorSpaceRcPtr linear = from.config->getColorSpace(ocio::ROLE_SCENE_LINEAR);
    if (!linear) return {};
    log.warn(from.name,
             std::string("has no scene-linear Rec.709 colour space (lin_rec709_scene); values are "
                         "taken as its scene_linear, '") +
                 linear->getName() + "'");
    return linear->getName();
}

}  // namespace obscura
