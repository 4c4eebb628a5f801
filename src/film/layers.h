// film/layers.h - the layers that an image may have beside its beauty, by name.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "stages/aov.h"

#include <span>
#include <string>
#include <variant>
#include <vector>

namespace obscura {

/// What a layer tells of the samples themselves.
enum class SampleStatistic { sample_count, variance, cost };

/// Whose names a Cryptomatte layer's ids stand for.
enum class CryptomatteNames { objects, materials, assets };

/// A layer that an image is asked for.
struct Layer {
    std::string name;                   ///< "normal"
    std::vector<std::string> channels;  ///< as files name them: "normal.X", "normal.Y", "normal.Z"
    LayerKind kind = LayerKind::data;
    std::string reduction;  ///< how samples become a pixel, for headers: "mean"
    std::variant<Aov, SampleStatistic, CryptomatteNames> source;
};

/// A line of `--list-aovs`.
struct LayerDescription {
    std::string name, channels, reduction, help;
};

/// Every layer that `layers_of` knows.
std::vector<LayerDescription> all_layers();

/// The layers with these names, in this order; a name that comes twice counts once.
///
/// In      crypto_levels: ids of a pixel that Cryptomatte layers keep
/// Errors  64 E-AOV-NAME with the names that there are
Result<std::vector<Layer>> layers_of(std::span<const std::string> names, int crypto_levels);

}  // namespace obscura
