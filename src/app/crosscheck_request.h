// app/crosscheck_request.h - the request of `obscura crosscheck`, checked.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/render_request.h"
#include "crosscheck/truth.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace obscura::app {

/// The texts of the options as they stood on the command line. Size, seed, threads, isa, camera,
/// quiet and verbose are those of `render`.
struct CrosscheckArguments {
    std::vector<std::string> scenes;
    RenderArguments render;
    std::optional<std::string> assets, rays, ray, json, image, export_embree;
};

struct CrosscheckRequest {
    std::vector<RenderRequest> scenes;  ///< at least one; they differ in the scene alone
    uint64_t rays = 1000000;
    std::optional<crosscheck::TrueRay> ray;  ///< only this one
    std::optional<std::filesystem::path> json;
    std::optional<std::filesystem::path> image;
    std::optional<std::filesystem::path> export_embree;
};

/// Defaults of --size.
inline constexpr const char* crosscheck_size = "640x360";

/// "ox,oy,oz,dx,dy,dz", optionally followed by the ray's end in lengths of its direction.
///
/// Errors  64 E-USAGE-NUMBER, E-USAGE-RANGE
Result<crosscheck::TrueRay> parse_ray(const std::string& text, const std::string& option);

/// "250000", "10M": a whole number, or one with k, M or G behind it.
///
/// Errors  64 E-USAGE-NUMBER, E-USAGE-RANGE: from 1 to 10^12
Result<uint64_t> parse_count(const std::string& text, const std::string& option);

/// Reads the texts; looks for assets when no scene is given.
///
/// Errors  those of make_render_request, with the same ids for the own options; 67 E-BENCH-ASSETS
Result<CrosscheckRequest> make_crosscheck_request(const CrosscheckArguments& arguments);

}  // namespace obscura::app
