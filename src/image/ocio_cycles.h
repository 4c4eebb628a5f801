// image/ocio_cycles.h - detects circular references in an OpenColorIO config.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenColorIO/OpenColorIO.h>

#include <string>

namespace obscura {

/// OpenColorIO resolves references by recursion without a bound, so a config whose colour spaces,
/// looks, views, named transforms or variables refer to each other in a circle overflows the stack.
///
/// In      transform: of the config, as it will be passed to Config::getProcessor
/// Out     "" if the references end, else a description of the fault, with the circle's names
std::string cyclic_references(const OCIO_NAMESPACE::Config& config,
                              const OCIO_NAMESPACE::ConstTransformRcPtr& transform);

}  // namespace obscura
