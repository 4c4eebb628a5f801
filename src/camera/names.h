// camera/names.h - the names of camera models and their kinds, as options and files write them.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "camera/camera.h"

#include <array>

namespace obscura {

template <typename T>
struct Named {
    const char* name;
    T value;
};

inline constexpr std::array<Named<CameraModel>, 5> camera_model_names = {
    {{"pinhole", CameraModel::pinhole},
     {"orthographic", CameraModel::orthographic},
     {"thinlens", CameraModel::thin_lens},
     {"fisheye", CameraModel::fisheye},
     {"environment", CameraModel::environment}}};

inline constexpr std::array<Named<FisheyeLaw>, 5> fisheye_law_names = {
    {{"equidistant", FisheyeLaw::equidistant},
     {"equisolid", FisheyeLaw::equisolid},
     {"stereographic", FisheyeLaw::stereographic},
     {"orthographic", FisheyeLaw::orthographic},
     {"opencv", FisheyeLaw::opencv}}};

inline constexpr std::array<Named<EnvironmentProjection>, 3> environment_projection_names = {
    {{"latlong", EnvironmentProjection::latlong},
     {"cylindrical", EnvironmentProjection::cylindrical},
     {"cubemap", EnvironmentProjection::cubemap}}};

/// The name of a value; every value must have one.
template <typename T, size_t N>
constexpr const char* name_of(const std::array<Named<T>, N>& names, T value) {
    for (const Named<T>& entry : names) {
        if (entry.value == value) return entry.name;
    }
    return "";
}

}  // namespace obscura
