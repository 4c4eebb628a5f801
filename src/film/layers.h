// film/layers.h - the layers that an image may have beside its beauty, by name.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "film/light_path_expression.h"
#include "stages/aov.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace obscura {

/// What a layer tells of the samples themselves.
enum class SampleStatistic { sample_count, variance, cost };

/// Whose names a Cryptomatte layer's ids stand for.
enum class CryptomatteNames { objects, materials, assets };

/// Direct light at first hits: what arrives there as a fraction of what would without occlusion.
struct ShadowRatio {};

/// A share of the light.
struct LightLayer {
    LightPathExpression expression;
    std::optional<size_t> group = {};  ///< light group that it is limited to, by index
    std::string shown = {};  ///< the expression for headers: with the group as the light's label
};
/// The node, as id_node numbers it, that most samples of a pixel meet; 0: most meet nothing. Of
/// equal counts the smaller number goes first, and any node before nothing.
struct MajorityNode {};

/// Which of a pixel's samples a mean is taken over. Halves are alternate runs of samples rather
/// than every other sample: runs of a power of two keep the stratification of Sobol points.
enum class SamplePart { all, first_half, second_half };

/// The mean over some of the samples, of an AOV or, without one, of the beauty's colour.
struct PartMean {
    std::optional<Aov> aov = {};
    SamplePart part = SamplePart::all;
    size_t run = 8;  ///< samples in a row that belong to one half; see half_run
};

/// How many of so many samples belong to the part.
size_t samples_in(const PartMean& mean, size_t samples);

/// The longest run, up to 8, with which both halves of so many samples have some.
size_t half_run(int samples_per_pixel);

/// A layer that an image is asked for.
struct Layer {
    std::string name;  ///< "normal"
    /// As files name them: "normal.X", "normal.Y", "normal.Z". Where a nearest layer has more than
    /// its AOV, they are masks: 1 where a sample hits.
    std::vector<std::string> channels;
    LayerKind kind = LayerKind::data;
    std::string reduction;  ///< how samples become a pixel, for headers: "mean"
    std::variant<Aov,
                 SampleStatistic,
                 CryptomatteNames,
                 LightLayer,
                 ShadowRatio,
                 MajorityNode,
                 PartMean>
        source;
};

/// Whether a layer is an AOV whose samples become a pixel in this way.
bool is_reduced(const Layer& layer, Reduction reduction);

bool is_cryptomatte(const Layer& layer);

/// A line of `--list-aovs`.
struct LayerDescription {
    std::string name, channels, reduction, help;
    std::string expression = {};  ///< of a share of the light
};

/// Every layer that `layers_of` knows.
std::vector<LayerDescription> all_layers();

/// The layer of `--segmentation`, which no name asks for: a file of its own holds it.
Layer segmentation_layer();

/// The layers that denoising needs besides the beauty.
std::vector<Layer> denoising_layers();

/// Of `--keep-noisy`: the beauty before denoising.
Layer noisy_layer();

/// The layers with these names, in this order; a name that comes twice counts once.
///
/// In      crypto_levels: ids of a pixel that Cryptomatte layers keep
/// Errors  64 E-AOV-NAME with the names that there are
Result<std::vector<Layer>> layers_of(std::span<const std::string> names, int crypto_levels);

/// A layer of the light that an expression accepts.
Layer light_layer(const std::string& name,
                  const LightPathExpression& expression,
                  std::optional<size_t> group = {});

/// Whether a name may stand in channels: letters, digits, - and _. A dot would begin another layer.
bool is_layer_name(std::string_view name);

/// The layer of `--lpe NAME=EXPRESSION`.
///
/// Errors  64 E-LPE; E-LAYER-NAME when the name is not made of letters, digits, - and _, or is that
///         of a layer that is no light, as "albedo" or "half_1"
Result<Layer> light_layer_of(const std::string& text);

/// Whether the paths' light must be told apart for one of the layers.
bool has_light_layers(std::span<const Layer> layers);

}  // namespace obscura
