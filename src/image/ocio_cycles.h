// image/ocio_cycles.h - finds what makes OpenColorIO follow a config's references for ever.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenColorIO/OpenColorIO.h>

#include <string>

namespace obscura {

/// OpenColorIO resolves references by recursion without a bound, so a config whose colour spaces,
/// looks, views, named transforms or variables refer to each other in a circle overflows the stack.
///
/// In      transform: of the config, as it will be handed to Config::getProcessor
/// Out     "" where the references come to an end, else what is wrong, with the circle's names
std::string endless_references(const OCIO_NAMESPACE::Config& config,
                               const OCIO_NAMESPACE::ConstTransformRcPtr& transform);

}  // namespace obscura
