// app/noise_options.cpp - the options for adaptive sampling and against fireflies: tables.
// SPDX-License-Identifier: Apache-2.0
#include "app/noise_options.h"

#include "app/render_options.h"
#include "app/render_request.h"

namespace obscura::app {

namespace {

using A = RenderArguments;
using O = RenderOptions;
using R = RenderRequest;
using Entry = RenderOptionEntry;

constexpr std::array<Choice<bool>, 2> caustics = {{{"on", true}, {"off", false}}};

/// The settings of adaptive sampling, which asking for any of them turns on.
AdaptiveOptions& adaptive_sampling(R& request) {
    if (!request.options.adaptive) request.options.adaptive.emplace();
    return *request.options.adaptive;
}

constexpr OptionReader<R> noise_target = {
    .read = [](const OptionInfo& info, const std::string& text, R& r) -> Result<void> {
        const auto& [low, high] = info.range;
        const Result<double> target = parse_real(text, long_name(info), low, high);
        if (!target) return fail(target.error());
        adaptive_sampling(r).noise_target = *target;
        return {};
    }};

constexpr OptionReader<R> min_samples = {
    .read = [](const OptionInfo& info, const std::string& text, R& r) -> Result<void> {
        const Result<int64_t> least = parse_integer(text, long_name(info), 2, 1 << 20);
        if (!least) return fail(least.error());
        adaptive_sampling(r).min_samples = static_cast<int>(*least);
        return {};
    }};

// clang-format off
constexpr Entry adaptive[] = {
    {{.name = "--noise-target", .argument = "X",
      .help = "Sample each pixel until the relative error of the picture is about X, more where it "
              "is noisy; up to --spp, or 4096 without it",
      .range = {1e-4, 1}, .fallback = "0.01 with --spp auto"},
     text_at<&A::noise_target>, noise_target},
    {{.name = "--spp-min", .argument = "N", .help = "Samples that every pixel takes at least",
      .range = {2, 1 << 20}, .fallback = "16", .needs = {"--noise-target", "--spp auto"}},
     text_at<&A::spp_min>, min_samples}};

constexpr Entry fireflies[] = {
    {{.name = "--clamp-indirect", .argument = "X",
      .help = "Against fireflies, at the price of a darker picture: no channel of what one path "
              "brings by way of several surfaces is more than X, in the scene's radiance; "
              "0: anything",
      .range = {0, 1e12}},
     text_at<&A::clamp_indirect>, number_at<&R::options, &O::clamp_indirect>},
    {{.name = "--clamp-direct", .argument = "X",
      .help = "The same for light that comes straight to the first surface; what the camera sees "
              "itself stays",
      .range = {0, 1e12}},
     text_at<&A::clamp_direct>, number_at<&R::options, &O::clamp_direct>},
    {{.name = "--caustics", .argument = "on|off",
      .help = "Light that mirrors and glass throw on rough surfaces; off: it is left out, and with "
              "it most fireflies"},
     text_at<&A::caustics>, choice_at<caustics, &R::options, &O::caustics>},
    {{.name = "--regularize",
      .help = "Once a path has met a rough surface, smooth ones are rougher to it: caustics are "
              "blurred and less noisy"},
     text_at<&A::regularize>, flag_at<&R::options, &O::regularize>}};

// clang-format on

}  // namespace

Result<void> read_samples(const OptionInfo& info, const std::string& text, R& request) {
    if (text == "auto") {
        adaptive_sampling(request);
        return {};
    }
    const auto read = read_number<&R::options, &O::samples_per_pixel>(info, text, request);
    if (read || read.error().id != "E-USAGE-NUMBER") return read;
    Error error = read.error();
    error.message += ", or auto";
    return fail(std::move(error));
}

OptionGroup<A, R> adaptive_group() {
    return {"Adaptive sampling", adaptive};
}

OptionGroup<A, R> fireflies_group() {
    return {"Against fireflies", fireflies};
}

}  // namespace obscura::app
