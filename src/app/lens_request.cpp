// app/lens_request.cpp - from the texts of the lens options to checked settings.
// SPDX-License-Identifier: Apache-2.0
#include "app/lens_request.h"

#include "app/frames.h"
#include "app/option_steps.h"
#include "camera/names.h"

#include <algorithm>

namespace obscura {

namespace {

constexpr double degree = pi_d / 180;
constexpr double longest_m = 1e12;

constexpr std::array<Named<FisheyeFit>, 2> fits = {
    {{"circle", FisheyeFit::circle}, {"diagonal", FisheyeFit::diagonal}}};
constexpr std::array<Named<EnvironmentAlign>, 2> aligns = {
    {{"world", EnvironmentAlign::world}, {"view", EnvironmentAlign::view}}};

/// Reads options into settings.
class Reader {
public:
    explicit Reader(OptionSteps& steps) : steps_(steps) {}

    struct Real {
        const char* name;
        double low, high;
        double scale = 1;
    };
    void real(const OptionText& text, const Real& what, std::optional<double>& out) {
        steps_.option(
            text,
            [&](const std::string& t) { return parse_real(t, what.name, what.low, what.high); },
            [&](double value) { out = value * what.scale; });
    }
    template <size_t N>
    void reals(const OptionText& text,
               const char* name,
               const NumberList& list,
               std::optional<std::array<double, N>>& out) {
        steps_.option(
            text,
            [&](const std::string& t) { return parse_numbers(t, name, list); },
            [&](const std::vector<double>& values) {
                out.emplace();
                out->fill(0);
                std::copy(values.begin(), values.end(), out->begin());
            });
    }
    template <typename T, size_t N>
    void choice(const OptionText& text,
                const char* name,
                const std::array<Named<T>, N>& names,
                std::optional<T>& out) {
        steps_.option(
            text,
            [&](const std::string& t) { return choose_option(t, name, names); },
            [&](T value) { out = value; });
    }

private:
    OptionSteps& steps_;
};

/// "36x24" in millimetres.
Result<std::array<double, 2>> parse_sensor(const std::string& text) {
    const NumberList list = {
        "WIDTHxHEIGHT in millimetres, such as 36x24, each from 0.1 to 10000", 2, 2, 0.1, 10000};
    std::string commas = text;
    const bool has_comma = text.find(',') != std::string::npos;
    std::replace(commas.begin(), commas.end(), 'x', ',');
    const Result<std::vector<double>> sides =
        parse_numbers(has_comma ? "," : commas, "--sensor", list);
    if (!sides) return fail(sides.error());
    return std::array<double, 2>{(*sides)[0] * 1e-3, (*sides)[1] * 1e-3};
}

/// "0.008" or "1/125".
Result<double> parse_shutter(const std::string& text) {
    const size_t slash = text.find('/');
    constexpr double shortest_s = 1e-7;
    constexpr double longest_s = 1e7;
    if (slash == std::string::npos) return parse_real(text, "--shutter", shortest_s, longest_s);
    const Result<double> above =
        parse_real(text.substr(0, slash), "--shutter", shortest_s, longest_s);
    if (!above) return above;
    const Result<double> below =
        parse_real(text.substr(slash + 1), "--shutter", shortest_s, longest_s);
    if (!below) return below;
    return *above / *below;
}

void read_film(const LensArguments& a, CameraSettings& s, OptionSteps& steps) {
    Reader read(steps);
    read.real(a.near_m, {"--near", 0, longest_m}, s.near_m);
    read.real(a.far_m, {"--far", 1e-9, longest_m}, s.far_m);
    read.reals(a.magnification,
               "--mag",
               {"XMAG,YMAG in metres, each from 1e-9 to 1e12", 2, 2, 1e-9, longest_m},
               s.magnification_m);
    read.real(a.focal_length, {"--focal-length", 0.01, 1e5, 1e-3}, s.focal_length_m);
    steps.option(a.sensor, parse_sensor, [&](const auto& sides) { s.sensor_m = sides; });
    read.reals(
        a.shift, "--shift", {"X,Y, each from -100 to 100 pictures", 2, 2, -100, 100}, s.shift);
    read.reals(a.distortion,
               "--distortion",
               {"K1,K2,P1,P2 or K1,K2,P1,P2,K3, each from -1e6 to 1e6", 4, 5, -1e6, 1e6},
               s.distortion);
    steps.refuse(a.sensor && !a.focal_length && !a.fstop,
                 "--sensor",
                 "it is for --focal-length or --fstop; add one of them");
}

void read_thin_lens(const LensArguments& a, CameraSettings& s, OptionSteps& steps) {
    Reader read(steps);
    read.real(a.fstop, {"--fstop", 0.01, 1e6}, s.fstop);
    read.real(a.lens_radius, {"--lens-radius", 0, 1e9}, s.lens_radius_m);
    read.real(a.focus_distance, {"--focus-distance", 1e-9, longest_m}, s.focus_distance_m);
    steps.option(
        a.blades,
        [](const std::string& text) { return parse_integer(text, "--blades", 3, 64); },
        [&](int64_t blades) { s.blades = static_cast<int>(blades); });
    read.real(a.blade_rotation, {"--blade-rotation", -36000, 36000, degree}, s.blade_rotation_rad);
    read.real(a.anamorphic, {"--anamorphic", 0.01, 100}, s.anamorphic);
    if (a.aperture) s.aperture_file = *a.aperture;
    steps.refuse(a.fstop && a.lens_radius,
                 "--lens-radius",
                 "it cannot go together with --fstop; give one or the other");
    steps.refuse(a.focus_on && a.focus_distance,
                 "--focus-on",
                 "it cannot go together with --focus-distance; give one or the other");
    steps.refuse(a.blades && a.aperture,
                 "--aperture",
                 "it cannot go together with --blades; give one or the other");
}

void read_wide(const LensArguments& a, CameraSettings& s, OptionSteps& steps) {
    Reader read(steps);
    read.choice(a.fisheye, "--fisheye", fisheye_law_names, s.fisheye);
    read.choice(a.fisheye_fit, "--fisheye-fit", fits, s.fisheye_fit);
    read.reals(a.fisheye_coefficients,
               "--fisheye-coefficients",
               {"K1,K2,K3,K4, each from -1e6 to 1e6", 4, 4, -1e6, 1e6},
               s.fisheye_k);
    read.choice(a.environment, "--environment", environment_projection_names, s.environment);
    read.real(a.stereo, {"--stereo", 0, 1e6}, s.stereo_m);
    read.choice(a.align, "--align", aligns, s.align);
    steps.refuse(s.fisheye_k && s.fisheye.value_or(FisheyeLaw::opencv) != FisheyeLaw::opencv,
                 "--fisheye-coefficients",
                 "they are for --fisheye opencv; leave out one or the other");
}

void read_exposure(const LensArguments& a, CameraSettings& s, OptionSteps& steps) {
    Reader read(steps);
    const bool exposes = a.shutter && !is_shutter_interval(*a.shutter);
    if (exposes) {
        steps.option(a.shutter, parse_shutter, [&](double seconds) { s.shutter_s = seconds; });
    }
    read.real(a.iso, {"--iso", 1e-3, 1e9}, s.iso);
    read.real(a.ev100, {"--ev100", -60, 60}, s.ev100);
    steps.refuse(a.ev100 && (exposes || a.iso),
                 "--ev100",
                 "it cannot go together with --shutter or --iso; give one or the other");
}

}  // namespace

Result<void> check_model_has(const CameraSettings& s, CameraModel model) {
    const std::string name = name_of(camera_model_names, model);
    OptionSteps steps;
    const auto only = [&](const auto& setting, const char* option, bool has_it) {
        steps.refuse(setting && !has_it,
                     option,
                     "a camera of the model " + name +
                         " does not have it; leave it out or choose another --camera-model");
    };
    const bool lens = model == CameraModel::thin_lens;
    const bool flat = lens || model == CameraModel::pinhole;
    const bool fisheye = model == CameraModel::fisheye;
    const bool around = model == CameraModel::environment;
    only(s.magnification_m, "--mag", model == CameraModel::orthographic);
    only(s.focal_length_m, "--focal-length", flat);
    only(s.sensor_m, "--sensor", flat);
    only(s.shift, "--shift", flat || fisheye);
    only(s.distortion, "--distortion", flat);
    only(s.fstop, "--fstop", lens || s.shutter_s);
    only(s.lens_radius_m, "--lens-radius", lens);
    only(s.focus_distance_m, "--focus-distance", lens);
    only(s.blades, "--blades", lens);
    only(s.blade_rotation_rad, "--blade-rotation", lens);
    only(s.anamorphic, "--anamorphic", lens);
    only(s.aperture_file, "--aperture", lens);
    only(s.fisheye, "--fisheye", fisheye);
    only(s.fisheye_fit, "--fisheye-fit", fisheye);
    only(s.fisheye_k, "--fisheye-coefficients", fisheye);
    only(s.environment, "--environment", around);
    only(s.stereo_m, "--stereo", around);
    only(s.align, "--align", around);
    return steps.done();
}

Result<CameraSettings> parse_lens(const LensArguments& arguments,
                                  const std::optional<CameraModel>& model) {
    CameraSettings settings;
    OptionSteps steps;
    read_film(arguments, settings, steps);
    read_thin_lens(arguments, settings, steps);
    read_wide(arguments, settings, steps);
    read_exposure(arguments, settings, steps);
    // Only a lens can be focused.
    if (arguments.focus_on && !implied_model(settings)) settings.model = CameraModel::thin_lens;
    // Without a model in sight the file decides: then choose_camera asks the same.
    const std::optional<CameraModel> meant = model ? model : implied_model(settings);
    steps.refuse(arguments.focus_on && meant && *meant != CameraModel::thin_lens,
                 "--focus-on",
                 "only a thin lens can be focused; leave it out or choose another --camera-model");
    Result<void> done = steps.done();
    if (done && meant) done = check_model_has(settings, *meant);
    if (!done) return fail(done.error());
    return settings;
}

}  // namespace obscura
