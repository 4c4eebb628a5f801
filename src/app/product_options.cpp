// app/product_options.cpp - the options for images of products: texts and tables.
// SPDX-License-Identifier: Apache-2.0
#include "app/product_options.h"

#include "app/option_readers.h"
#include "app/render_options.h"
#include "app/render_request.h"
#include "render/integrators.h"

namespace obscura::app {

namespace {

using A = RenderArguments;
using C = CameraRequest;
using F = FramingOptions;
using L = gltf::LoadOptions;
using O = RenderOptions;
using P = ProductArguments;
using R = RenderRequest;
using Entry = OptionEntry<A, R>;

constexpr double brightest_factor = 1e6;
constexpr double degree = pi_d / 180;
constexpr double percent = 0.01;

constexpr std::array<Choice<FrameFit>, 2> frame_fits = {
    {{"tight", FrameFit::tight}, {"sphere", FrameFit::sphere}}};

constexpr std::array<Choice<TransparentGlass>, 3> glass_kinds = {
    {{"auto", TransparentGlass::automatic},
     {"on", TransparentGlass::on},
     {"off", TransparentGlass::off}}};

/// "Lamp=0.5" or "Lamp=off".
Result<gltf::LightChoice::Factor> parse_light_factor(const std::string& text,
                                                     const std::string& option) {
    const size_t equals = text.rfind('=');
    if (equals == std::string::npos || equals == 0) {
        return fail(ExitCode::usage,
                    "E-USAGE-CHOICE",
                    option,
                    in_quotes(text) +
                        " is not accepted; expected keep, off, or NAME=X such as "
                        "Lamp=0.5,Rim*=off");
    }
    gltf::LightChoice::Factor out{text.substr(0, equals), 0};
    const std::string factor = text.substr(equals + 1);
    if (factor == "off") return out;
    const Result<double> number = parse_real(factor, option, 0, brightest_factor);
    if (!number) return fail(number.error());
    out.factor = *number;
    return out;
}

/// Adds one of several patterns.
Result<void> read_hidden(const OptionInfo& info, const std::string& text, R& request) {
    const Result<std::string> pattern = parse_name(text, info.name);
    if (!pattern) return fail(pattern.error());
    request.load.hidden.push_back(*pattern);
    return {};
}

/// Adds a pattern of parts that get a visibility flag.
template <uint8_t flag>
Result<void> read_flagged(const OptionInfo& info, const std::string& text, R& request) {
    const Result<std::string> pattern = parse_name(text, info.name);
    if (!pattern) return fail(pattern.error());
    request.load.visibility.push_back({*pattern, flag});
    return {};
}

Result<void> read_catcher(const OptionInfo& info, const std::string& text, R& request) {
    if (text != "ground") return read_flagged<visibility_catcher>(info, text, request);
    request.catcher_ground = true;
    return {};
}

// clang-format off
constexpr Entry framing[] = {
    {{.name = "--azimuth", .argument = "DEG",
      .help = "Frame the scene from this side: 0 is the front (+Z), 90 the right (+X)",
      .range = {-36000, 36000}, .scale = degree, .fallback = "30",
      .excludes = {"--eye", "--target", "--up", "--camera-json"}},
     text_at<&A::product, &P::azimuth>, number_at<&R::camera, &C::framing, &F::azimuth_rad>},
    {{.name = "--elevation", .argument = "DEG", .help = "And from so far above the horizon",
      .range = {-90, 90}, .scale = degree, .fallback = "20",
      .excludes = {"--eye", "--target", "--up", "--camera-json"}},
     text_at<&A::product, &P::elevation>, number_at<&R::camera, &C::framing, &F::elevation_rad>},
    {{.name = "--roll", .argument = "DEG", .help = "Turns the framed image clockwise",
      .range = {-36000, 36000}, .scale = degree, .fallback = "0",
      .excludes = {"--eye", "--target", "--up", "--camera-json"}},
     text_at<&A::product, &P::roll>, number_at<&R::camera, &C::framing, &F::roll_rad>},
    {{.name = "--zoom", .argument = "X", .help = "Enlarges the framed image about its middle",
      .range = {0.01, 1000}, .excludes = {"--eye", "--target", "--up", "--camera-json"}},
     text_at<&A::product, &P::zoom>, number_at<&R::camera, &C::framing, &F::zoom>},
    {{.name = "--margin", .argument = "PERCENT",
      .help = "Of the image's width and height, what the framing leaves free on each side",
      .range = {0, 45}, .scale = percent, .fallback = "5",
      .excludes = {"--camera-json"}},
     text_at<&A::product, &P::margin>, number_at<&R::camera, &C::framing, &F::margin>},
    {{.name = "--frame", .argument = "NAME",
      .help = "tight: what is seen reaches to the margins; sphere: the same scale from all sides. "
              "One of:",
      .excludes = {"--camera-json"}},
     text_at<&A::product, &P::frame>, choice_at<frame_fits, &R::camera, &C::framing, &F::fit>},
    {{.name = "--focus-node", .argument = "PATTERN",
      .help = "Frame the nodes of this name and all below them. * and ? stand for any text and "
              "letter",
      .fallback = "the whole scene", .excludes = {"--camera-json"}},
     text_at<&A::product, &P::focus_node>, name_at<&R::camera, &C::framed_node>}};

constexpr Entry light_choice[] = {
    {{.name = "--lights", .argument = "keep|off|NAME=X",
      .help = "What becomes of the file's lamps: keep; off, as if the file had none; or "
              "NAME=X,NAME=X, which makes those of a name or of a node X times as bright, or off. "
              "* and ? stand for any text and letter; of several that fit, the last counts",
      .fallback = "keep"},
     text_at<&A::product, &P::lights>, parsed_at<parse_lights, &R::load, &L::lights>}};

constexpr Entry parts[] = {
    {{.name = "--hide", .argument = "PATTERN",
      .help = "Leave out the nodes of this name, with all below them, and what has the mesh or "
              "material of this name. * and ? stand for any text and letter. May be given several "
              "times",
      .fallback = "all is shown"},
     text_at<&A::product, &P::hide>, {.read = read_hidden}},
    {{.name = "--holdout", .argument = "PATTERN",
      .help = "Cut the parts of this name, as for --hide, out of the image: black and transparent "
              "where the camera sees them, ordinary for light, shadows and reflections",
      .fallback = "none"},
     text_at<&A::product, &P::holdout>, {.read = read_flagged<visibility_holdout>}},
    {{.name = "--camera-invisible", .argument = "PATTERN",
      .help = "The camera looks through the parts of this name, as for --hide; shadows and "
              "reflections stay",
      .fallback = "none"},
     text_at<&A::product, &P::camera_invisible>, {.read = read_flagged<visibility_no_camera>}},
    {{.name = "--no-shadow", .argument = "PATTERN",
      .help = "The parts of this name, as for --hide, cast no shadows", .fallback = "none"},
     text_at<&A::product, &P::no_shadow>, {.read = read_flagged<visibility_no_shadow>}},
    {{.name = "--catcher", .argument = "ground|PATTERN",
      .help = "Show nothing but the shadow, as a black of some alpha, on ground, a plane below "
              "what is framed, or on the parts of this name, as for --hide. Best with "
              "--background transparent. May be given several times",
      .fallback = "none"},
     text_at<&A::product, &P::catcher>, {.read = read_catcher}},
    {{.name = "--catcher-reflections",
      .help = "Catchers reflect the rest, as a lacquer of roughness 0.2 does",
      .fallback = "shadows alone", .needs = {"--catcher"}},
     text_at<&A::product, &P::catcher_reflections>, flag_at<&R::options, &O::catcher_reflections>},
    {{.name = "--transparent-glass", .argument = "KIND",
      .help = "Clear glass shows catchers and a transparent background: what it lets through, the "
              "mean of red, green and blue, leaves the image's alpha, and its colour is what it "
              "reflects. auto is on where there are catchers. One of:"},
     text_at<&A::product, &P::transparent_glass>,
     choice_at<glass_kinds, &R::options, &O::transparent_glass>},
    {{.name = "--transparent-glass-roughness", .argument = "X",
      .help = "Glass of this roughness at most counts as clear", .range = {0, 1}},
     text_at<&A::product, &P::transparent_glass_roughness>,
     number_at<&R::options, &O::clear_roughness>}};
// clang-format on

}  // namespace

Result<gltf::LightChoice> parse_lights(const std::string& text, const std::string& option) {
    gltf::LightChoice out;
    out.off = text == "off";
    if (out.off || text == "keep") return out;
    for (size_t begin = 0; begin <= text.size();) {
        const size_t end = std::min(text.find(',', begin), text.size());
        const Result<gltf::LightChoice::Factor> factor =
            parse_light_factor(text.substr(begin, end - begin), option);
        if (!factor) return fail(factor.error());
        out.factors.push_back(*factor);
        begin = end + 1;
    }
    return out;
}

Result<void> complete_framing(const ProductArguments& arguments,
                              const OptionText& choice,
                              CameraRequest& camera) {
    const std::array<std::pair<const char*, const OptionText*>, 7> all = {
        {{"--azimuth", &arguments.azimuth},
         {"--elevation", &arguments.elevation},
         {"--roll", &arguments.roll},
         {"--zoom", &arguments.zoom},
         {"--margin", &arguments.margin},
         {"--frame", &arguments.frame},
         {"--focus-node", &arguments.focus_node}}};
    camera.frames = choice == "auto";
    for (const auto& [name, text] : all) {
        if (!*text) continue;
        if (choice && choice != "auto") {
            return fail(ExitCode::usage,
                        "E-USAGE-CONFLICT",
                        name,
                        "it frames the scene, which a camera of the file does not; leave it out, "
                        "or give --camera auto");
        }
        camera.frames = true;
    }
    return {};
}

Result<void> check_catchers(const ProductArguments& arguments, const RenderRequest& request) {
    const IntegratorEntry& integrator = entry_of(request.options.integrator);
    if (arguments.catcher.empty() || has_catchers(integrator.value)) return {};
    return fail(ExitCode::usage,
                "E-USAGE-CONFLICT",
                "--catcher",
                std::string("shadows are caught by --integrator path and direct, not by ") +
                    integrator.name);
}

OptionGroup<A, R> framing_group() {
    return {"Framing", framing};
}

OptionGroup<A, R> light_choice_group() {
    return {"Light", light_choice};
}

OptionGroup<A, R> part_group() {
    return {"Parts", parts};
}

}  // namespace obscura::app
