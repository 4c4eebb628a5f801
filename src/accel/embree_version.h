// accel/embree_version.h - the version of the Embree that rays are traced with.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace obscura {

/// "3.13.5", of the library as it is loaded; "": it does not start, which building a BVH reports.
std::string embree_version();

}  // namespace obscura
