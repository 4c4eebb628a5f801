// film/cryptomatte.h - Cryptomatte layers: ids of names, channels, metadata and coverage by rank.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "film/state_bytes.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace obscura {

// A Cryptomatte layer ("crypto_object") stores for each pixel which objects it shows and how much
// of it each of them covers. Compositors make a matte of any object from it: the sum of the
// coverages that stand beside the object's id.
//
// Source  Friedman, Jones, "Cryptomatte Specification", version 1.2.0, Psyop (BSD 3-clause)

/// The ranks of a layer that the specification suggests.
inline constexpr size_t default_cryptomatte_levels = 6;

/// The hash of samples that meet nothing. No name has it.
inline constexpr uint32_t cryptomatte_no_object = 0;

/// The bits of a name's id: its MurmurHash3, in which an exponent of all zeros or all ones has its
/// lowest bit flipped. So the id is a normal float, neither 0 nor denormal, infinite or NaN, which
/// programs between here and the compositor could change.
///
/// In      name: UTF-8. All bytes count, also white space at its ends; there is no normalization.
///         Equal names share one id and so one matte, which the specification wants
/// Source  sections "Names", "Hash" and "Floating point conversion"
uint32_t cryptomatte_hash(std::string_view name) noexcept;

/// The id as pixels store it: the float with the hash's bits; 0 for cryptomatte_no_object.
float cryptomatte_id(uint32_t hash) noexcept;

/// What the header attributes of a layer begin with: "cryptomatte/f834d0a" for "crypto_object".
/// With seven digits of the layer's hash the longest attribute has 30 characters; readers of old
/// OpenEXR files allow 31.
std::string cryptomatte_key(std::string_view layer);

/// The channels of a layer, two a rank: "crypto_object00.r" has the first id, ".g" its coverage,
/// ".b" the second id, ".a" its coverage; "crypto_object01.r" goes on. Levels are rounded up to an
/// even number, so that every numbered layer has all four.
///
/// The letters are lower-case as in the specification, also because DWA compression of OpenEXR is
/// lossy for channels R, G and B: ids must keep all their bits, in 32-bit channels. The channels
/// of a preview ("crypto_object.r"), deprecated since version 1.2.0, are left out.
///
/// Source  sections "Layer naming" and "Channel contents"
std::vector<std::string> cryptomatte_channels(std::string_view layer, size_t levels);

/// The manifest for a header: a JSON object on one line from each name to the eight hexadecimal
/// digits of its hash. Names are sorted by their bytes and stand there once. Control characters
/// are escaped as JSON does, so that a header needs to escape nothing more; bytes that are not
/// UTF-8 are shown as U+FFFD.
///
/// Source  section "Manifest"
std::string cryptomatte_manifest(std::span<const std::string> names);

/// The same manifest as the text of a file, a name a line.
std::string cryptomatte_manifest_document(std::span<const std::string> names);

/// A text attribute of an EXR header.
struct CryptomatteAttribute {
    std::string name;  ///< with the key: "cryptomatte/f834d0a/hash"
    std::string text;
};

/// The attributes of a layer with its manifest in the header.
///
/// In      manifest: of cryptomatte_manifest
/// Source  section "Metadata"
std::vector<CryptomatteAttribute> cryptomatte_attributes(std::string_view layer,
                                                         std::string manifest);

/// The attributes of a layer with its manifest in another file.
///
/// In      file: in the folder of the image
/// Source  section "Metadata"
std::vector<CryptomatteAttribute> cryptomatte_file_attributes(std::string_view layer,
                                                              std::string file);

/// How many samples of a pixel met each object, in one layer.
///
/// Film points are drawn from the pixel filter, so all samples weigh the same, and the counts do
/// not depend on their order. A sample with the id of the one before costs a comparison and an
/// addition. Up to four ids live in the 64 bytes; further ones are allocated.
class CryptomattePixel {
public:
    /// Counts samples.
    ///
    /// In      hash: of cryptomatte_hash, or cryptomatte_no_object
    void add(uint32_t hash, uint32_t samples) {
        if (hash != run_.hash) start_run(hash);
        run_.count += samples;
    }

    /// Counts the samples of another one, too.
    void append(const CryptomattePixel& other);

    /// Writes the ids of largest coverage in descending order; of equal ones the smaller hash comes
    /// first. Coverage is the fraction of the pixel's samples. Ranks that are left over get 0, 0;
    /// objects beyond the last rank are dropped, and the others keep their coverage.
    ///
    /// In      samples: all of the pixel, with those that met nothing
    /// Out     ranks: id, coverage, id, coverage, ..., one float for each of cryptomatte_channels
    /// Source  section "Ranking Pixel Filter"
    void write_ranks(uint32_t samples, std::span<float> ranks) const;

    /// The id that most samples met; cryptomatte_no_object when more met nothing. Of equal counts
    /// the smaller id goes first.
    ///
    /// In      samples: all of the pixel, with those that met nothing
    uint32_t majority(uint32_t samples) const;

    /// All of it, to go on from.
    void put(StateWriter& out) const;
    void take(StateReader& in);

private:
    struct IdCount {
        uint32_t hash = cryptomatte_no_object;
        uint32_t count = 0;
    };

    static bool ranks_before(IdCount a, IdCount b) noexcept;
    void start_run(uint32_t hash);
    void end_run();
    IdCount next_rank(IdCount last) const noexcept;

    IdCount run_;                  ///< samples since the id last changed
    std::array<IdCount, 4> few_;   ///< the first ids, in the order in which they came
    std::vector<IdCount> others_;  ///< further ids, by hash
};

static_assert(sizeof(CryptomattePixel) == 64, "one cache line");

}  // namespace obscura
