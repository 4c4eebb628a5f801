// film/layer_sums.h - samples of layers become pixels, tile by tile.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "film/catcher_sums.h"
#include "film/cryptomatte.h"
#include "film/film.h"
#include "stages/wavefront.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace obscura {

/// Hashes of the names that ids stand for, by the number of an id AOV (index plus 1).
struct CryptomatteHashes {
    std::vector<uint32_t> objects;    ///< by id_node
    std::vector<uint32_t> materials;  ///< by id_material
    std::vector<uint32_t> assets;     ///< by id_node
    std::vector<uint32_t> nodes;      ///< by id_node: the number itself, for MajorityNode
};

/// The pixels of a batch, with so many samples each.
struct BatchShape {
    std::span<const uint32_t> pixels;  ///< their numbers in the tile
    size_t samples = 0;
    size_t first_sample = 0;  ///< number of the first of them
};

/// The pixels of a tile.
struct SampledPixels {
    std::span<const size_t> at;            ///< index of each in the film
    std::span<const int> samples;          ///< how many it has
    std::span<const CatcherSum> catchers;  ///< what its shadow catchers received; empty: none
};

/// What the layers of an image need from the wavefront loop; the same for all tiles.
class LayerPlan {
public:
    LayerPlan() = default;
    /// In      catches: the image has shadow catchers
    LayerPlan(std::span<const Layer> layers, CryptomatteHashes hashes, bool catches = false);

    /// The AOVs to write for every sample, each once.
    std::span<const Aov> aovs() const { return aovs_; }
    bool counts_rays() const { return counts_rays_; }
    bool empty() const { return layers_.empty(); }

private:
    friend class LayerSums;

    /// Where a layer's values come from, and where its sums are.
    struct Source {
        size_t aov = 0;                    ///< index in aovs_, for AOVs and Cryptomatte
        size_t first_sum = 0;              ///< number of its first sum, for means
        size_t first_behind = 0;           ///< likewise, of light behind shadow catchers
        size_t first_value = 0;            ///< of a pixel's nearest values
        const uint32_t* hashes = nullptr;  ///< for Cryptomatte and MajorityNode
        size_t hash_count = 0;
        size_t matte = 0;  ///< index of its pixels, likewise
        size_t light = 0;  ///< number among the light layers
    };

    /// A layer of the nearest sample's values.
    struct Nearest {
        size_t aov = 0;          ///< index in aovs_
        size_t first_value = 0;  ///< as of Source
        size_t own = 0;          ///< channels of the AOV
        size_t channels = 0;     ///< of the layer; those beyond its own are 1
    };

    bool has_nearest() const { return !nearest_.empty(); }
    size_t written_aov(Aov aov);
    void add_layer(const Layer& layer);

    std::vector<Layer> layers_;
    std::vector<Source> sources_;  ///< by layer
    std::vector<Nearest> nearest_;
    std::vector<Aov> aovs_;
    CryptomatteHashes hashes_;
    size_t sums_ = 0;                    ///< a pixel's sums of AOVs and light
    size_t values_ = 0;                  ///< a pixel's nearest values
    size_t mattes_ = 0;                  ///< layers that count ids
    size_t lights_ = 0;                  ///< light layers
    size_t parts_ = 0;                   ///< layers of a part of the samples
    size_t opacity_ = 0, distance_ = 0;  ///< in aovs_
    bool counts_rays_ = false;
    bool has_variance_ = false;
    bool has_shadow_ = false;
    bool catches_ = false;
};

/// Layers of light are red, green and blue.
inline constexpr size_t light_channels = 3;

/// Bytes that LayerSums takes for a layer, of each pixel, at most.
///
/// In      catches: the image has shadow catchers
size_t sum_bytes(const Layer& layer, bool catches);

/// The sums of one tile's pixels; reused from tile to tile. Samples are added in the order of their
/// numbers, so that the result does not depend on how they are cut into batches.
class LayerSums {
public:
    /// Begins a tile of `pixels` pixels.
    void begin(const LayerPlan& plan, size_t pixels);

    /// Adds a batch: sample i of pixel p of the batch is at p * samples + i.
    void add(const LayerPlan& plan, const BatchShape& batch, const Workspace&);

    /// Writes the tile's pixels to the film's layers, which are 0: those of light that did not
    /// arrive stay as they are.
    void store(const LayerPlan& plan, const SampledPixels& pixels, Film& film) const;

    /// All of them, to go on from; `take` after `begin` with the same plan.
    void put(StateWriter& out) const;
    void take(StateReader& in);

    /// Puts the sums of a block that has just ended, and begins those of the next one. Counts and
    /// nearest hits do not depend on the order of samples, and go on.
    void end_block(StateWriter& out);
    /// Takes what end_block put, into new sums.
    void take_block(StateReader& in);
    /// Adds the sums of the samples that follow: of one block at most, which begins where these
    /// end.
    void append(const LayerSums& later);

private:
    /// A sum whose latest samples are floats, of which sixteen add up to 1e-6. They are in four
    /// parts, each of every fourth sample: they need not wait for each other.
    struct Sum {
        double blocks = 0;  ///< of finished blocks
        std::array<float, 4> parts = {0, 0, 0, 0};

        double total() const {
            return blocks + static_cast<double>((parts[0] + parts[1]) + (parts[2] + parts[3]));
        }
        void end_block() { *this = {total()}; }
    };
    struct Luminance {
        double sum = 0, squares = 0;

        Luminance& operator+=(const Luminance& other) {
            sum += other.sum;
            squares += other.squares;
            return *this;
        }
    };

    /// The sums of the tile's pixels for some channels, side by side.
    Sum* begun_sums(size_t first_sum, size_t channels);
    /// The same; nullptr: nothing was added.
    const Sum* sums_of(size_t first_sum) const;
    float statistic(SampleStatistic statistic, size_t pixel, double samples) const;
    template <size_t N>
    static void add_to_block(const std::array<const float*, N>& columns,
                             size_t index,
                             size_t number,
                             size_t count,
                             std::array<Sum, N>& sums);
    template <size_t N>
    static void add_blocks(const BatchShape&,
                           const std::array<const float*, N>& columns,
                           Sum* begun);
    template <size_t N>
    void add_columns(const BatchShape&,
                     const std::array<const float*, N>& columns,
                     size_t first_sum);
    void end_blocks(const BatchShape&, size_t first_sum, size_t channels);
    void store_light(const LayerPlan::Source&, const SampledPixels&, FilmLayer&) const;
    void store_ratio(const LayerPlan::Source&, const SampledPixels&, FilmLayer&) const;
    void add_means(const LayerPlan& plan, const BatchShape&, const Workspace&);
    void add_light(const LayerPlan& plan, const BatchShape&, const Workspace&);
    void add_parts(const LayerPlan& plan, const BatchShape&, const Workspace&);
    void add_nearest(const LayerPlan& plan, const BatchShape&, const Workspace&);
    void add_mattes(const LayerPlan& plan, const BatchShape&, const Workspace&);
    void add_statistics(const LayerPlan&, const BatchShape&, const Workspace&);
    void put_sums(StateWriter& out) const;
    void take_sums(StateReader& in);

    size_t pixels_ = 0;
    std::vector<Sum> sums_;              ///< by number of the first of some channels, then by pixel
    std::vector<uint8_t> sums_are_new_;  ///< by number: nothing was added in this tile
    std::vector<float> nearest_values_;
    std::vector<float> nearest_m_;  ///< distance of the nearest hit so far; infinite: none
    std::vector<BlockSum<Luminance>> luminance_;
    std::vector<uint64_t> rays_;
    std::vector<CryptomattePixel> mattes_;
};

}  // namespace obscura
