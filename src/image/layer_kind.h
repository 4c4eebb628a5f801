// image/layer_kind.h - what the numbers of an image layer mean.
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace obscura {

/// What a layer of an image holds, and so how it may be stored: colours as half floats and with
/// losses, data (depth, normals) and ids never. Ids are not averaged either.
enum class LayerKind { color, data, id };

}  // namespace obscura
