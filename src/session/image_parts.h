// session/image_parts.h - parts of one picture in files, and the picture made of all of them.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "film/film_state.h"
#include "render/film_sums.h"
#include "session/render_request.h"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace obscura {

/// The file of a part, beside the picture: "shot.exr.2-of-7.film".
std::filesystem::path part_file(const std::filesystem::path& output, const FilmPart& part);

/// The file of a checkpoint: the one that was asked for, else "shot.exr.checkpoint" beside the
/// picture or part. In a sequence it is the frame's.
///
/// In      request: its outputs are those of the frame
std::filesystem::path checkpoint_file(const RenderRequest& request);

/// Checksums of files, each of which is read once.
class FileChecksums {
public:
    /// Nothing: it cannot be read.
    std::optional<std::string> of(const std::filesystem::path& file);

private:
    std::map<std::filesystem::path, std::optional<std::string>> known_;
};

/// Whether a part of a picture is rendered, not some of a sequence's frames.
bool is_part_of_image(const RenderRequest& request);
/// Whether that is a part of its samples.
bool is_part_of_samples(const RenderRequest& request);

/// What the names of facts_of begin with that tell of the asset's own files; the file's follows.
inline constexpr std::string_view asset_file_fact = "the file ";

/// What the pixels depend on beside the options: the program's and Embree's versions, the
/// instruction set, and the checksum of every file that is read. A file that cannot be read is
/// missing among them; loading reports it.
///
/// In      asset: those of facts_of_asset; isa, embree: of the prepared scene
NamedTexts facts_of(const RenderRequest& request,
                    const NamedTexts& asset,
                    const std::string& isa,
                    const std::string& embree,
                    FileChecksums& checksums);

/// The part of these that tells of an asset's own files.
NamedTexts facts_of_asset(const std::vector<std::filesystem::path>& files);

/// What differs between the options, without the names of outputs, or else the facts of two
/// renderings: "--spp: 16 and 64; --seed: nothing and 7"; "": nothing.
std::string differences(const FilmStateHead& one, const FilmStateHead& two);

/// The parts of one picture, in any order.
class ImageParts {
public:
    /// Reads the files once, to see that they belong together and are complete.
    ///
    /// Errors  those of read_film_state; 78 E-PART-MIX parts of different pictures, with what
    ///         differs; 78 E-PART-SET parts that are missing or there twice
    static Result<ImageParts> open(const std::vector<std::filesystem::path>& files);

    /// The options of the command that rendered them.
    const NamedTexts& options() const { return options_; }
    /// Sums over all parts.
    const RenderCounters& counters() const { return counters_; }

    /// Whether they were rendered from what is there now.
    ///
    /// Errors  78 E-PART-MIX
    Result<void> check_facts(const NamedTexts& facts) const;

    /// Whether they are parts of the samples of all pixels, not of the pixels.
    bool are_of_samples() const { return part_of_ == PartOf::samples; }
    /// Fills all pixels of a film; of one that is rendered in passes, with samples.
    ///
    /// Errors  those of read_film_state; 74 E-PART-DAMAGED a part has other tiles or samples
    Result<void> fill(Film& film) const;
    Result<void> fill(const PassFilm& film) const;

private:
    std::vector<std::filesystem::path> files_;  ///< by the numbers of the parts
    PartOf part_of_ = PartOf::rows;
    NamedTexts options_, facts_;
    RenderCounters counters_;
};

}  // namespace obscura
