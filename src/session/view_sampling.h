// session/view_sampling.h - random views of an asset, for data sets.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/vec.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace obscura {

struct CameraRequest;
struct View;

/// Where random cameras are: around the asset, on all sides or not below its middle; or inside its
/// bounding box, as in a room.
enum class ViewSpace { sphere, hemisphere, box };

struct ViewSampling {
    int count = 0;  ///< 0: no random views
    ViewSpace space = ViewSpace::sphere;
    uint64_t seed = 0;
    /// Around an asset: the share of the image's height or width that its bounding sphere takes.
    std::array<double, 2> fill = {0.5, 0.9};
    bool turns_environment = true;  ///< by any angle, in every view another
    bool chooses_variant = true;    ///< of those that the asset has, all alike
};

/// One of the views from inside that are tried, until one of them shows something.
struct InsideView {
    uint64_t seed = 0;
    int number = 0;   ///< of the image
    int attempt = 0;  ///< from 0 on
};

/// Where it stands in the scene's box, from 0 to 1 along each axis, and where it looks.
struct InsidePlace {
    Vec3d place = {0.5, 0.5, 0.5};
    double azimuth_rad = 0, elevation_rad = 0;  ///< as those of FramingOptions
};
InsidePlace sample_inside(const InsideView& view);

/// Views by chance, named 000000 and so on. A view depends on the seed and its number alone, not on
/// the count.
///
/// In      camera: what all views have in common; variants: those of the asset
std::vector<View> sample_views(const ViewSampling& sampling,
                               const CameraRequest& camera,
                               const std::vector<std::string>& variants);

}  // namespace obscura
