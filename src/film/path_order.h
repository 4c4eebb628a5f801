// film/path_order.h - checks that paths begin with the camera and end with a light.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "film/light_path_expression.h"

#include <optional>
#include <vector>

namespace obscura {

/// What is wrong with the order of events, for an error.
struct PathOrderFault {
    size_t column = 0;  ///< of the event, from 1; 0: it is the expression as a whole
    std::string message;
};

/// The first event that has no place in a path: before the camera, a second camera, after a light,
/// or one that nothing fits; else whether all paths end with a light, and there are any.
///
/// In      nodes: children before parents, as in LightPathExpression
std::optional<PathOrderFault> find_path_order_fault(const std::vector<PathNode>& nodes);

}  // namespace obscura
