// app/bench_request.h - the request of `obscura bench`, checked and ready to use.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/bench_views.h"
#include "app/render_request.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace obscura::app {

/// The texts of the options as they stood on the command line. The options of `render` for size,
/// sampling, camera, light, quiet and verbose apply; threads and isa are lists here.
struct BenchArguments {
    std::vector<std::string> scenes;
    RenderArguments render;
    std::optional<std::string> assets, json, compare, plot, view, repeat, threads, isa;
    bool standard = false;
};

struct BenchRequest {
    bool standard = false;              ///< --standard: its scenes, not those below
    std::vector<RenderRequest> scenes;  ///< else at least one; they differ in the scene alone
    ViewChoice views = ViewChoice::both;
    int repeat = 5;
    std::vector<int> threads;  ///< at least one; the first gives the main figures
    std::vector<Isa> isas;     ///< likewise
    std::optional<std::filesystem::path> json;
    std::optional<std::filesystem::path> plot;
    std::optional<std::filesystem::path> compare;
    Verbosity verbosity = Verbosity::normal;
};

/// Defaults of --size and --spp: AOVs take one sample a pixel, so they get more pixels.
inline constexpr std::array<int, 2> bench_size = {640, 360};
inline constexpr std::array<int, 2> bench_aov_size = {1920, 1080};
inline constexpr const char* bench_spp = "4";

/// Each thread count once, 0 as the number of cores; the greatest first.
Result<std::vector<int>> parse_thread_counts(const std::string& text, const std::string& option);

/// Each instruction set once, in the order given; "all" means those of this CPU, widest first.
Result<std::vector<Isa>> parse_isas(const std::string& text, const std::string& option);

/// Reads the texts; looks for assets when no scene is given.
///
/// Errors  those of make_render_request, with the same ids for the bench's own options;
///         67 E-BENCH-ASSETS
Result<BenchRequest> make_bench_request(const BenchArguments& arguments);

}  // namespace obscura::app
