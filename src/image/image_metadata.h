// image/image_metadata.h - what an image's header says besides its pixels.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "image/rendering_space.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace obscura {

using AttributeValue = std::variant<std::string, int, float, double>;

/// An attribute of an EXR's header, by its name there. Names of ours begin with "obscura:".
struct ImageAttribute {
    std::string name;
    AttributeValue value;
};

/// The time of an image in a sequence, without dropped frames.
struct TimeCode {
    int hours = 0;  ///< 0 to 23
    int minutes = 0;
    int seconds = 0;
    int frame = 0;  ///< 0 to 29
};

/// OpenEXR's standard attributes; what is empty is not written.
///
/// Source  OpenEXR, "Standard Attributes"
struct StandardAttributes {
    /// Row-major 4x4 for row vectors, as camera/matrices.h makes them.
    std::optional<std::array<float, 16>> world_to_camera = {};
    std::optional<std::array<float, 16>> world_to_ndc = {};
    float screen_window_width = 1;                       ///< of no perspective image 1
    std::array<float, 2> screen_window_center = {0, 0};  ///< +x is left, +y up
    std::optional<float> fstop = {};                     ///< aperture
    std::optional<float> exposure_s = {};                ///< expTime
    std::optional<float> iso = {};                       ///< isoSpeed
    std::optional<float> focus_m = {};                   ///< focus
    std::optional<float> white_luminance = {};           ///< of RGB (1, 1, 1) in nits
    std::optional<double> frame_rate_hz =
        {};                                  ///< framesPerSecond, a fraction: 23.976 is 24000/1001
    std::optional<TimeCode> time_code = {};  ///< timeCode
    std::string capture_date = {};           ///< capDate: YYYY:MM:DD hh:mm:ss
    bool is_latlong = false;                 ///< envmap: a whole sphere
    /// Of stereo, "left" and "right": they lie one above the other in the image, all as high. A
    /// multipart file has parts of each, and their `view`; the others have the image as it is.
    std::vector<std::string> views = {};
};

/// Metadata of an image. An EXR has the standard attributes, Software, copyright (also as owner),
/// colorInteropID (of the space where it has one, or "data"), chromaticities (colour only),
/// obscura:asset, obscura:samplesPerPixel (int), obscura:seed (int; text beyond 2^31 - 1, so that
/// it stays exact) and the extra ones; PNG, JPEG, TIFF and WebP have Software, Copyright and
/// the fingerprint. Nothing in it depends on the time or machine of a run, so that equal images are
/// equal files.
struct ImageMetadata {
    std::string software;   ///< "Obscura 0.1.0"
    std::string asset;      ///< the asset's file name
    std::string copyright;  ///< asset.copyright, may be empty
    int samples_per_pixel = 0;
    uint64_t seed = 0;
    RenderingSpace space = {};  ///< of all colours
    bool is_color = true;       ///< of the beauty; false: data such as depth; no chromaticities
    StandardAttributes standard = {};
    std::vector<ImageAttribute> extra;  ///< further attributes; empty texts are left out
};

}  // namespace obscura
