// app/lens_options.cpp - the table of the options for cameras beyond the pinhole.
// SPDX-License-Identifier: Apache-2.0
#include "app/lens_options.h"

#include "app/frames.h"
#include "app/option_readers.h"
#include "app/render_request.h"
#include "math/warp.h"
#include "scene/camera_setting_table.h"

namespace obscura::app {

namespace {

using A = RenderArguments;
using C = CameraRequest;
using L = LensArguments;
using R = RenderRequest;
using S = CameraSettings;
using Entry = OptionEntry<A, R>;

constexpr double millimetre = 1e-3;
/// The names of a setting that is an enumeration.
template <auto member>
constexpr auto setting_choices = camera_setting_of<member>().choices;

/// An entry with the range and names of the table of settings, in the option's unit.
template <auto text, auto member, size_t least = 0>
constexpr Entry setting(OptionInfo info) {
    using T = FieldValue<member>;
    const auto& range = camera_setting_of<member>().info.range;
    if (!(info.range.low < info.range.high)) {
        info.range = {range.low / info.scale, range.high / info.scale};
    }
    Entry entry{info, text_at<&A::lens, text>};
    if constexpr (std::is_enum_v<T>) {
        entry.reader = choice_at<setting_choices<member>, &R::camera, &C::settings, member>;
    } else if constexpr (std::is_arithmetic_v<T>) {
        entry.reader = number_at<&R::camera, &C::settings, member>;
    } else {
        constexpr size_t all = std::tuple_size_v<T>;
        entry.reader = numbers_at < least == 0 ? all : least, &R::camera, &C::settings, member > ;
    }
    return entry;
}

/// "36x24" in millimetres.
Result<std::array<double, 2>> parse_sensor(const std::string& text, const std::string& option) {
    const NumberList list = {
        "WIDTHxHEIGHT in millimetres, such as 36x24, each from 0.1 to 10000", 2, 2, 0.1, 10000};
    std::string commas = text;
    const bool has_comma = text.find(',') != std::string::npos;
    std::replace(commas.begin(), commas.end(), 'x', ',');
    const Result<std::vector<double>> sides = parse_numbers(has_comma ? "," : commas, option, list);
    if (!sides) return fail(sides.error());
    return std::array<double, 2>{(*sides)[0] * millimetre, (*sides)[1] * millimetre};
}

/// "0.008" or "1/125" seconds of exposure; or an interval of frames.
Result<void> read_shutter(const OptionInfo& info, const std::string& text, R& request) {
    if (is_shutter_interval(text)) {
        const Result<ShutterFractions> interval = parse_shutter_interval(text);
        if (!interval) return fail(interval.error());
        request.shutter = *interval;
        return {};
    }
    const auto& [low, high] = camera_setting_of<&S::shutter_s>().info.range;
    const size_t slash = text.find('/');
    const Result<double> above = parse_real(text.substr(0, slash), info.name, low, high);
    if (!above) return fail(above.error());
    request.camera.settings.shutter_s = *above;
    if (slash == std::string::npos) return {};
    const Result<double> below = parse_real(text.substr(slash + 1), info.name, low, high);
    if (!below) return fail(below.error());
    request.camera.settings.shutter_s = *above / *below;
    return {};
}

// clang-format off
constexpr Entry film[] = {
    {{.name = "--camera-json", .argument = "FILE",
      .help = "A camera as computer vision writes it: fx fy cx cy, distortion, world to camera "
              "(docs/cameras.md)",
      .files = "json", .excludes = {"--camera", "--eye", "--target", "--up"}},
     text_at<&A::lens, &L::camera_json>, name_at<&R::camera_json>},
    setting<&L::focal_length, &S::focal_length_m>({.name = "--focal-length", .argument = "MM",
        .help = "With --sensor: sets the angle of view", .scale = millimetre}),
    {{.name = "--sensor", .argument = "WxH",
      .help = "Size of the film in millimetres, such as 36x24",
      .needs = {"--focal-length", "--fstop"}},
     text_at<&A::lens, &L::sensor>,
     parsed_at<parse_sensor, &R::camera, &C::settings, &S::sensor_m>},
    setting<&L::shift, &S::shift>({.name = "--shift", .argument = "X,Y",
        .help = "Moves the film by so many pictures to the right and up, without turning the "
                "camera",
        .accepted = "X,Y, each from -100 to 100 pictures", .fallback = "0,0"}),
    setting<&L::magnification, &S::magnification_m>({.name = "--mag", .argument = "X,Y",
        .help = "Orthographic: half width and half height in metres, as glTF's xmag and ymag",
        .accepted = "XMAG,YMAG in metres, each from 1e-9 to 1e12"}),
    setting<&L::distortion, &S::distortion, 4>({.name = "--distortion",
        .argument = "K1,K2,P1,P2[,K3]",
        .help = "Of a pinhole or thin lens, as OpenCV defines them",
        .accepted = "K1,K2,P1,P2 or K1,K2,P1,P2,K3, each from -1e6 to 1e6"}),
    setting<&L::near_m, &S::near_m>({.name = "--near", .argument = "METRES",
        .help = "Show nothing nearer", .fallback = "all is shown"}),
    setting<&L::far_m, &S::far_m>({.name = "--far", .argument = "METRES",
        .help = "Show nothing further", .fallback = "all is shown"})};

constexpr Entry thin_lens[] = {
    setting<&L::fstop, &S::fstop>({.name = "--fstop", .argument = "N",
        .help = "Focal length over opening; without --focal-length it is that of 35 mm film"}),
    setting<&L::lens_radius, &S::lens_radius_m>({.name = "--lens-radius", .argument = "METRES",
        .help = "Half the opening; 0 is a pinhole", .excludes = {"--fstop"}}),
    setting<&L::focus_distance, &S::focus_distance_m>({.name = "--focus-distance",
        .argument = "METRES", .help = "To the sharp plane, along the view",
        .fallback = "to --target, or the middle of the scene"}),
    {{.name = "--focus-on", .argument = "X,Y", .help = "Make sharp what this pixel shows",
      .excludes = {"--focus-distance"}},
     text_at<&A::lens, &L::focus_on>, parsed_at<parse_pixel, &R::camera, &C::focus_on_px>},
    setting<&L::blades, &S::blades>({.name = "--blades", .argument = "N",
        .help = "Opening with so many edges", .fallback = "round"}),
    setting<&L::blade_rotation, &S::blade_rotation_rad>({.name = "--blade-rotation",
        .argument = "DEG", .help = "Turns the opening", .range = {-36000, 36000},
        .scale = radians_per_degree, .fallback = "0"}),
    setting<&L::anamorphic, &S::anamorphic>({.name = "--anamorphic", .argument = "X",
        .help = "Opening so many times as high as wide", .fallback = "1"}),
    {{.name = "--aperture", .argument = "FILE",
      .help = "Opening as a picture, PNG, JPEG, WebP or KTX2: light passes where it is bright",
      .files = "png jpg jpeg webp ktx2", .excludes = {"--blades"}},
     text_at<&A::lens, &L::aperture>, name_at<&R::camera, &C::settings, &S::aperture_file>}};

constexpr Entry fisheye[] = {
    setting<&L::fisheye, &S::fisheye>({.name = "--fisheye", .argument = "NAME",
        .help = "How angles become distances from the middle:", .fallback = "equidistant"}),
    setting<&L::fisheye_fit, &S::fisheye_fit>({.name = "--fisheye-fit", .argument = "NAME",
        .help = "circle: all of it in the picture; diagonal: it reaches the corners",
        .fallback = "circle"}),
    setting<&L::fisheye_coefficients, &S::fisheye_k>({.name = "--fisheye-coefficients",
        .argument = "K1,K2,K3,K4", .help = "Of the opencv fisheye (Kannala-Brandt)",
        .accepted = "K1,K2,K3,K4, each from -1e6 to 1e6", .fallback = "0,0,0,0"})};

constexpr Entry around[] = {
    setting<&L::environment, &S::environment>({.name = "--environment", .argument = "NAME",
        .help = "How directions lie in the picture:", .fallback = "latlong"}),
    setting<&L::stereo, &S::stereo_m>({.name = "--stereo", .argument = "METRES",
        .help = "Two eyes so far apart: the left one above, the right one below, each seen "
                "straight ahead in every direction",
        .fallback = "one eye"}),
    setting<&L::align, &S::align>({.name = "--align", .argument = "NAME",
        .help = "world: +X in the middle, as --env reads maps; view: what is ahead",
        .fallback = "world"})};

constexpr Entry exposure[] = {
    {{.name = "--shutter", .argument = "SECONDS|OPEN,CLOSE",
      .help = "Such as 0.008 or 1/125; needs --fstop. Or OPEN,CLOSE, in frames from the picture's "
              "time, such as 0,0.5: motion blur in every kind of picture"},
     text_at<&A::lens, &L::shutter>, {.read = read_shutter}},
    setting<&L::iso, &S::iso>({.name = "--iso", .argument = "N", .help = "Sensitivity",
        .fallback = "100"}),
    setting<&L::ev100, &S::ev100>({.name = "--ev100", .argument = "EV",
        .help = "Exposure value at ISO 100, instead of these", .excludes = {"--iso"}})};
// clang-format on

constexpr OptionGroup<A, R> groups[] = {{"Film", film},
                                        {"Lens (--camera-model thinlens)", thin_lens},
                                        {"Fisheye (--camera-model fisheye)", fisheye},
                                        {"All around (--camera-model environment)", around},
                                        {"Photographic exposure (all but EXR)", exposure}};

}  // namespace

std::span<const OptionGroup<A, R>> lens_option_groups() {
    return groups;
}

}  // namespace obscura::app
