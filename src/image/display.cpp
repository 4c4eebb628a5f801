// image/display.cpp - converts scene-linear values by an OpenColorIO display and view.
// SPDX-License-Identifier: Apache-2.0
#include "image/display.h"

#include "base/setting_names.h"
#include "image/code_points.h"
#include "image/ocio_cycles.h"
#include "image/ocio_load.h"
#include "image/pbr_neutral.h"
#include "image/rendering_space.h"

#include <OpenColorIO/OpenColorIO.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace obscura {

namespace ocio = OCIO_NAMESPACE;

struct DisplayTransform::Impl {
    ocio::ConstCPUProcessorRcPtr processor;
    float exposure = 1;
    std::optional<Matrix3> rec709_from_scene;
    bool pbr_neutral = false;
    std::optional<ColorCodePoints> code_points;
};

namespace {

struct DisplayAndView {
    std::string display;
    std::string view;
};

std::vector<std::string> displays_of(const ocio::Config& config) {
    std::vector<std::string> out;
    for (int i = 0; i < config.getNumDisplays(); ++i)
        out.emplace_back(config.getDisplay(i));
    return out;
}

std::vector<std::string> views_of(const ocio::Config& config, const std::string& display) {
    std::vector<std::string> out;
    for (int i = 0; i < config.getNumViews(display.c_str()); ++i)
        out.emplace_back(config.getView(display.c_str(), i));
    return out;
}

/// Brings one of the names to the front; the others keep their order.
void put_first(std::vector<std::string>& names, const std::string& first) {
    const auto found = std::find(names.begin(), names.end(), first);
    if (found != names.end()) std::rotate(names.begin(), found, found + 1);
}

Result<DisplayAndView> choose(const NamedConfig& from, const DisplayOptions& options) {
    const ocio::Config& config = *from.config;
    DisplayAndView chosen{config.getDefaultDisplay(), {}};
    if (!options.display.empty()) {
        const std::vector<std::string> displays = displays_of(config);
        chosen.display = find_name(displays, options.display);
        if (chosen.display.empty()) {
            return bad_configuration(
                "E-OCIO-DISPLAY",
                setting("display") + " " + options.display,
                from.name + " has no such display; it has " + quoted_list(displays));
        }
    }
    chosen.view = config.getDefaultView(chosen.display.c_str());
    if (!options.view.empty()) {
        const std::vector<std::string> views = views_of(config, chosen.display);
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

}  // namespace

Result<std::vector<DisplayChoice>> display_choices(const std::string& ocio_file, Log& log) {
    const Result<NamedConfig> from = load_config(ocio_file, log);
    if (!from) return fail(from.error());
    const ocio::Config& config = *from->config;
    std::vector<std::string> displays = displays_of(config);
    put_first(displays, config.getDefaultDisplay());
    std::vector<DisplayChoice> out;
    for (const std::string& display : displays) {
        out.push_back({display, views_of(config, display)});
        put_first(out.back().views, config.getDefaultView(display.c_str()));
    }
    return out;
}

DisplayTransform::DisplayTransform(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
DisplayTransform::DisplayTransform(DisplayTransform&&) noexcept = default;
DisplayTransform& DisplayTransform::operator=(DisplayTransform&&) noexcept = default;
DisplayTransform::~DisplayTransform() = default;

Result<DisplayTransform> DisplayTransform::create(const DisplayOptions& options, Log& log) {
    const Result<NamedConfig> from = load_config(options.ocio_file, log);
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
        impl->rec709_from_scene = options.rec709_from_scene;
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
        if (impl_->rec709_from_scene) {
            convert_colors(*impl_->rec709_from_scene, std::span(part, 3 * pixels));
        }
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
