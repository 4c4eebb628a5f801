// serve/drake.h - what Drake's render client asks for: a form, and the query of its endpoint.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/camera_settings.h"

#include "serve/view_settings.h"
#include <array>
#include <map>
#include <optional>
#include <string>

namespace obscura::serve {

/// Fields of a form by their names.
using Form = std::map<std::string, std::string>;
/// The query of a URL.
using Query = std::multimap<std::string, std::string>;

enum class DrakeImage { color, depth, label };

/// One image of a scene, as Drake's form describes it.
struct DrakeRequest {
    DrakeImage image = DrakeImage::color;
    std::string sha256;  ///< of the scene, in lower case
    int width = 0, height = 0;
    double near_m = 0, far_m = 0;  ///< nothing else is seen
    Intrinsics intrinsics;
    /// Of a depth image: what lies nearer or further away is told as "too near" and "too far".
    std::array<double, 2> depth_range_m = {};
};

/// Reads and checks the fields; those that are not Drake's are ignored. The angles of view say
/// nothing that the focal lengths do not: they only have to be angles, where they are there.
///
/// Source  Drake, "glTF Render Client-Server API"
/// Errors  64 E-DRAKE-FIELD a field is missing, or has a value that cannot be
Result<DrakeRequest> read_drake_form(const Form& form);

/// How label images are sent: as colours, which Drake makes numbers of, or as these numbers.
enum class LabelEncoding { color, number };

/// What the endpoint's query adds.
struct DrakeSettings {
    bool z_up = true;  ///< as Drake's worlds are
    LabelEncoding labels = LabelEncoding::color;
    Options options = Options::object();  ///< of `obscura render`
};

/// Errors  64 E-DRAKE-OPTION a name that there is not, or one that the form decides
Result<DrakeSettings> read_drake_query(const Query& query);

/// Puts the camera and the size of the image into a request: the file's first camera, with the
/// intrinsics and clipping of the form.
void apply(const DrakeRequest& wanted, RenderRequest& request);

/// What a depth sensor says of a distance along the view axis: 0 where something is too near,
/// infinity where it is too far away or nothing is there.
///
/// In      depth_m: 0: nothing is there
float sensed_depth(float depth_m, const std::array<double, 2>& range_m);

/// The bytes in which Drake has written a label as a colour, of a material's base colour: it took
/// them for fractions of 255, without a display's curve.
///
/// Source  Drake, geometry/render/render_engine.h, MakeRgbFromLabel
std::array<uint8_t, 3> label_color(const float* base_color);

/// The label of such a colour.
uint16_t label_number(const std::array<uint8_t, 3>& color);

/// Where there is nothing of Drake's scene: white, which Drake reads as "don't care"; in numbers,
/// its RenderLabel::kEmpty.
inline constexpr std::array<uint8_t, 3> empty_label_color = {255, 255, 255};
inline constexpr uint16_t empty_label_number = 32766;

}  // namespace obscura::serve
