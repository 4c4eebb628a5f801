// image/display.cpp - converts scene-linear values by an OpenColorIO display and view.
// SPDX-License-Identifier: Apache-2.0
#include "image/display.h"

#include "base/setting_names.h"
#include "image/code_points.h"
#include "image/ocio_config.h"
#include "image/ocio_cycles.h"
#include "image/pbr_neutral.h"

#include <OpenColorIO/OpenColorIO.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <mutex>
#include <sstream>
#include <utility>
#include <vector>

namespace obscura {

namespace ocio = OCIO_NAMESPACE;

struct DisplayTransform::Impl {
    ocio::ConstCPUProcessorRcPtr processor;
    float exposure = 1;
    bool pbr_neutral = false;
    std::optional<ColorCodePoints> code_points;
};

namespace {

constexpr std::uintmax_t largest_config_bytes = 64U << 20;

tl::unexpected<Error> bad_configuration(const char* id,
                                        const std::string& where,
                                        std::string message) {
    return fail(ExitCode::configuration, id, where, std::move(message));
}

/// Redirects OpenColorIO's notes from standard error to our log while it exists. The library has
/// one log function for all threads, so these objects exclude each other.
class OcioNotesToLog {
public:
    OcioNotesToLog(Log& log, const std::string& where) : turn_(one_at_a_time) {
        ocio::SetLoggingFunction([&log, where](const char* text) {
            std::string line = text;
            while (!line.empty() && line.back() == '\n')
                line.pop_back();
            if (!line.empty()) log.detail(where + ": " + line);
        });
    }
    ~OcioNotesToLog() { ocio::ResetToDefaultLoggingFunction(); }
    OcioNotesToLog(const OcioNotesToLog&) = delete;
    OcioNotesToLog& operator=(const OcioNotesToLog&) = delete;

private:
    static inline std::recursive_mutex one_at_a_time;
    std::lock_guard<std::recursive_mutex> turn_;
};

/// A config with the name that messages use for it.
struct NamedConfig {
    ocio::ConstConfigRcPtr config;
    std::string name;
    bool is_builtin = false;
};

/// "" when `file` may be opened: not a pipe or device, which would block, and not absurdly large.
std::string why_unreadable(const std::string& file) {
    if (file.rfind("ocio://", 0) == 0) return {};  // a config inside the library, from 2.2 on
    std::error_code error;
    const auto status = std::filesystem::status(file, error);
    if (!std::filesystem::exists(status)) return "there is no such file";
    if (!std::filesystem::is_regular_file(status)) return "this is not a regular file";
    const auto size = std::filesystem::file_size(file, error);
    if (!error && size > largest_config_bytes) return "larger than 64 MB";
    return {};
}

Result<NamedConfig> load_config(const DisplayOptions& options, Log& log) {
    const char* variable = std::getenv("OCIO");
    const bool from_option = !options.ocio_file.empty();
    const std::string file = from_option ? options.ocio_file : variable ? variable : "";
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

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    return text;
}

/// The entry of `names` that equals `wanted` regardless of case; "" for none.
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

struct DisplayAndView {
    std::string display;
    std::string view;
};

Result<DisplayAndView> choose(const NamedConfig& from, const DisplayOptions& options) {
    const ocio::Config& config = *from.config;
    DisplayAndView chosen{config.getDefaultDisplay(), {}};
    if (!options.display.empty()) {
        std::vector<std::string> displays;
        for (int i = 0; i < config.getNumDisplays(); ++i)
            displays.push_back(config.getDisplay(i));
        chosen.display = find_name(displays, options.display);
        if (chosen.display.empty()) {
            return bad_configuration(
                "E-OCIO-DISPLAY",
                setting("display") + " " + options.display,
                from.name + " has no such display; it has " + quoted_list(displays));
        }
    }
    const char* display = chosen.display.c_str();
    chosen.view = config.getDefaultView(display);
    if (!options.view.empty()) {
        std::vector<std::string> views;
        for (int i = 0; i < config.getNumViews(display); ++i) {
            views.push_back(config.getView(display, i));
        }
        chosen.view = find_name(views, options.view);
        if (chosen.view.empty()) {
            return bad_configuration("E-OCIO-VIEW",
                                     setting("view") + " " + options.view,
                                     "display '" + chosen.display + "' of " + from.name +
                                         " has no such view; it has " + quoted_list(views));
        }
    }
    return chosen;
}

/// A config's name for scene-linear Rec.709, else its scene_linear role with a warning; "" if it
/// has neither.
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

}  // namespace

DisplayTransform::DisplayTransform(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
DisplayTransform::DisplayTransform(DisplayTransform&&) noexcept = default;
DisplayTransform& DisplayTransform::operator=(DisplayTransform&&) noexcept = default;
DisplayTransform::~DisplayTransform() = default;

Result<DisplayTransform> DisplayTransform::create(const DisplayOptions& options, Log& log) {
    const Result<NamedConfig> from = load_config(options, log);
    if (!from) return fail(from.error());
    try {
        const OcioNotesToLog notes(log, from->name);
        const Result<DisplayAndView> chosen = choose(*from, options);
        if (!chosen) return fail(chosen.error());
        const std::string space = input_space(*from, log);
        if (space.empty()) {
            return bad_configuration("E-OCIO-FILE",
                                     from->name,
                                     "has neither a colour space lin_rec709_scene nor a role "
                                     "scene_linear; one of them is needed");
        }
        const auto transform = ocio::DisplayViewTransform::Create();
        transform->setSrc(space.c_str());
        transform->setDisplay(chosen->display.c_str());
        transform->setView(chosen->view.c_str());
        const std::string cycle = cyclic_references(*from->config, transform);
        if (!cycle.empty()) return bad_configuration("E-OCIO-CYCLE", from->name, cycle);
        auto impl = std::make_unique<Impl>();
        impl->processor = from->config->getProcessor(transform)->getDefaultCPUProcessor();
        impl->exposure = static_cast<float>(std::exp2(options.exposure_ev));
        impl->pbr_neutral = from->is_builtin && chosen->view == "Khronos PBR Neutral";
        impl->code_points = find_code_points(*from->config, chosen->display, chosen->view);
        return DisplayTransform(std::move(impl));
    } catch (const std::exception& error) {
        return bad_configuration("E-OCIO-FILE", from->name, error.what());
    }
}

const std::optional<ColorCodePoints>& DisplayTransform::code_points() const {
    return impl_->code_points;
}

void DisplayTransform::apply(float* rgb, size_t count) const {
    constexpr float largest = 65504;  // the largest half: beyond it every display is white
    constexpr size_t at_once = 4096;  // stays in the second-level cache between the steps
    for (size_t first = 0; first < count; first += at_once) {
        float* part = rgb + 3 * first;
        const size_t pixels = std::min(at_once, count - first);
        for (size_t i = 0; i < 3 * pixels; ++i) {
            const float value = part[i] * impl_->exposure;
            part[i] = std::isnan(value) ? 0.0f : std::clamp(value, -largest, largest);
        }
        if (impl_->pbr_neutral) {
            for (size_t i = 0; i < 3 * pixels; ++i)
                part[i] = std::max(part[i], 0.0f);
            for (size_t i = 0; i < pixels; ++i)
                tone_map_pbr_neutral(part + 3 * i);
        }
        ocio::PackedImageDesc image(part, static_cast<long>(pixels), 1, 3);
        impl_->processor->apply(image);
        for (size_t i = 0; i < 3 * pixels; ++i) {
            part[i] = std::isnan(part[i]) ? 0.0f : std::clamp(part[i], 0.0f, 1.0f);
        }
    }
}

}  // namespace obscura
