// session/film_keeper.h - keeps what is finished of an image: in a file to go on from, or to show.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/log.h"
#include "base/stopwatch.h"
#include "film/film_state.h"
#include "render/film_sums.h"

#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace obscura {

/// Whether a rendering goes on from a checkpoint that is there.
enum class Resume { automatic, require, never };

/// Follows the rendering of one film. Its checkpoint is a film state, with what its pixels depend
/// on: the sums of all pixels where the film is rendered in passes, else the tiles that are
/// finished. There are two generations, `file` and `file`.1, so that one is whole whatever happens.
class FilmKeeper {
public:
    /// In      head: part, options, facts; target_samples where the film is rendered in passes
    ///         file: none: nothing is written
    FilmKeeper(FilmStateHead head, std::optional<std::filesystem::path> file);

    /// Looks for a checkpoint to go on from; with `never` removes it. Damaged ones cause a warning.
    /// One of fewer samples fits, too, where their number changes no sample.
    ///
    /// Errors  78 E-RESUME-MIX it is of another rendering, with what differs;
    ///         74 E-RESUME-NONE it is required, and there is none that is whole; 33 E-MEM
    Result<void> find(Resume resume, Log& log);

    /// For FilmShare and ProgressFunction. `add` may be called from any thread.
    ///
    /// Errors  of fill and begin_passes: those of read_film_state
    Result<std::vector<FilmArea>> fill(Film& film);
    Result<void> begin_passes(const PassFilm& film);
    void add(const FinishedTile& tile);
    void leave();

    /// Writes a checkpoint of the film that is being rendered, from another thread. False, and none
    /// is written: nothing was finished since the latest, or the film is not there yet, or has gone
    /// elsewhere.
    ///
    /// Errors  those of write_film_state
    Result<bool> save_meanwhile();
    /// Likewise, of a film that has left.
    Result<bool> save(const Film& film);
    /// Removes the checkpoint and the one before it.
    void remove() const;

    /// What there is of the film that is being rendered, 0 elsewhere; none: it has left.
    std::optional<Film> film_so_far() const;
    /// The same of a film that has left.
    Film finished_of(Film&& film) const;

    /// The fraction of the part's pixels that are finished; in passes, of its samples.
    double fraction() const;
    /// The sums of a film that is rendered in passes; null: it is not.
    const FilmSums* sums() const { return sums_.get(); }
    /// Counters of the tiles that came from the checkpoint.
    const RenderCounters& resumed_counters() const { return resumed_; }
    /// The same fraction when the latest checkpoint was begun, or of the one that was read.
    double saved_fraction() const;
    /// Time since a checkpoint was written; infinite: none was since the start.
    double seconds_since_save() const;
    /// The checkpoint's file where one was written or read; "": none was.
    std::string file_if_kept() const;

private:
    FilmStateHead head_so_far() const;
    int64_t amount_of(const FilmStateHead& head) const;
    Result<void> write(const FilmStateHead& head, const Film& film) const;

    const std::optional<std::filesystem::path> file_;
    std::optional<std::filesystem::path> found_;  ///< the generation to go on from
    bool is_newest_whole_ = false;                ///< whether `file_` is there and not damaged
    RenderCounters resumed_;
    mutable std::mutex using_film_;  ///< held while film_ is read; locked before mutex_
    const Film* film_ = nullptr;
    std::optional<PassFilm> passes_;  ///< while film_ is there
    std::shared_ptr<FilmSums> sums_;  ///< from begin_passes on
    mutable std::mutex mutex_;        ///< of what follows
    FilmStateHead head_;              ///< with areas and counters so far
    int64_t saved_ = 0;               ///< areas or samples that the latest checkpoint holds
    double saved_fraction_ = 0;
    std::optional<Stopwatch> since_save_;
    bool is_kept_ = false;
};

}  // namespace obscura
