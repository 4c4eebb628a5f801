// film/film_state.h - a film in a file, finished areas or sums, with what its pixels depend on.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "film/film.h"
#include "film/state_bytes.h"
#include "stages/pixel_sum.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

namespace obscura {

/// What parts of a film divide among them: its rows, or the samples of every pixel.
enum class PartOf { rows, samples };

/// One of several equal shares of a film.
struct FilmPart {
    int index = 0;  ///< from 0
    int count = 1;
    PartOf of = PartOf::rows;
    bool operator==(const FilmPart&) const = default;
};

inline constexpr int max_film_parts = 100000;

struct RowRange {
    int first = 0, count = 0;
};

/// A rectangle of a film's pixels.
struct FilmArea {
    int x = 0, y = 0, width = 0, height = 0;
    bool operator==(const FilmArea&) const = default;
};

/// The number of pixels in all of them.
int64_t pixels_in(std::span<const FilmArea> areas);

/// The rows of a part: bands, dealt out in turn, so that parts take about as long. Of many parts
/// bands are thin, so that each part still has several. A part has no rows when there are more
/// parts than rows. The only part, and one of samples, has all rows in one band.
std::vector<RowRange> rows_of_part(int height, const FilmPart& part);

/// The samples that a part has of every pixel, whole blocks of sum_block_samples: none when there
/// are more parts than blocks. A part of rows has all of them.
SampleRange samples_of_part(int samples, const FilmPart& part);

/// The rows of a part as areas of a film.
std::vector<FilmArea> areas_of_part(int width, int height, const FilmPart& part);

/// What a file holds beside pixels.
struct FilmStateHead {
    FilmPart part;       ///< that is being rendered: of one, all of the film
    NamedTexts options;  ///< of the command, as they were given
    NamedTexts facts;    ///< program, instruction set, checksums of files
    std::array<uint64_t, 6> counters = {};
    int width = 0, height = 0;
    NamedTexts images;  ///< the beauty's and each layer's name, with its channels
    /// Of a file of sums: the samples that a pixel is to have in the end. 0: a file of pixels.
    int target_samples = 0;
    bool is_adaptive = false;  ///< pixels have fewer where their noise is low
    /// Whose pixels the file holds; none is in two of them. A file of sums has areas when all of
    /// its part's samples are there, which only parts of samples say.
    std::vector<FilmArea> areas;
};

/// True when the areas are all of the part: nothing is left to be rendered.
bool is_whole(const FilmStateHead& head);

/// A film's beauty and layers as FilmStateHead::images names them.
NamedTexts images_of(const Film& film);

/// Writes the pixels of head.areas, whole or not at all: magic, the head, float32 pixels, area by
/// area, in it image by image, row by row; then the checksum of all of that. All numbers are
/// little-endian.
///
/// In      head: the size and the images that are written are the film's
///         film: other threads may be writing its pixels outside the areas
/// Errors  those of write_file_atomically
Result<void> write_film_state(const std::filesystem::path& file,
                              const FilmStateHead& head,
                              const Film& film);

/// Reads a file and checks all of it.
///
/// In      film: null: the head is wanted alone; else as large, and with the images, that the head
///         names; its areas are filled
/// Errors  74 E-PART-DAMAGED the file cannot be read, is cut off, or its checksum does not fit;
///         78 E-PART-MIX it is of another version, or of another film; 33 E-MEM
Result<FilmStateHead> read_film_state(const std::filesystem::path& file, Film* film);

/// The same for a film that is rendered in passes: sums in place of pixels.
///
/// In      film: its size and the names of its images are written, but not its pixels
///         put_sums: writes what take_sums will read
Result<void> write_film_sums(const std::filesystem::path& file,
                             const FilmStateHead& head,
                             const Film& film,
                             const std::function<void(StateWriter&)>& put_sums);
Result<FilmStateHead> read_film_sums(const std::filesystem::path& file,
                                     const Film& film,
                                     const std::function<void(StateReader&)>& take_sums);

/// Copies the pixels of some areas, beauty and layers; all others are 0.
Film copy_areas(const Film& film, std::span<const FilmArea> areas);

}  // namespace obscura
