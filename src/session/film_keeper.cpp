// session/film_keeper.cpp - keeps what is finished of an image, to go on from or to show.
// SPDX-License-Identifier: Apache-2.0
#include "session/film_keeper.h"

#include "base/atomic_file.h"
#include "render/counts.h"
#include "render/integrators.h"
#include "session/image_parts.h"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <system_error>

namespace obscura {

namespace {

namespace fs = std::filesystem;

fs::path previous(const fs::path& file) {
    fs::path out = file;
    out += ".1";
    return out;
}

std::string text_of(const FilmPart& part) {
    const char* const of = part.of == PartOf::samples ? " by samples" : "";
    return fmt::format("{}/{}{}", part.index + 1, part.count, of);
}

bool is_there(const fs::path& file) {
    std::error_code error;
    return fs::exists(file, error);
}

/// The fraction of the part's pixels that are in finished areas.
double fraction_of(const FilmStateHead& head) {
    const int64_t all = pixels_in(areas_of_part(head.width, head.height, head.part));
    if (all == 0) return 0;
    return static_cast<double>(pixels_in(head.areas)) / static_cast<double>(all);
}

/// What differs between a checkpoint and the rendering that may go on from it; "": nothing.
std::string differences_from(FilmStateHead kept, FilmStateHead wanted) {
    const bool in_passes = kept.target_samples > 0 && wanted.target_samples > 0;
    const bool may_take_more = wanted.part.of == PartOf::rows && !kept.is_adaptive;
    const bool go_on = kept.target_samples == wanted.target_samples ||
                       (may_take_more && kept.target_samples >= min_samples_to_go_on &&
                        wanted.target_samples > kept.target_samples);
    if (in_passes && go_on && kept.is_adaptive == wanted.is_adaptive) {
        for (NamedTexts* const options : {&kept.options, &wanted.options}) {
            const auto is_spp = [](const auto& option) { return option.first == "--spp"; };
            options->erase(std::remove_if(options->begin(), options->end(), is_spp),
                           options->end());
        }
    }
    std::string differs = differences(kept, wanted);
    if (differs.empty() && !(kept.part == wanted.part))
        differs = "--part: " + text_of(kept.part) + " and " + text_of(wanted.part);
    return differs;
}

}  // namespace

FilmKeeper::FilmKeeper(FilmStateHead head, std::optional<fs::path> file)
    : file_(std::move(file)), head_(std::move(head)) {}

Result<void> FilmKeeper::find(Resume resume, Log& log) {
    if (!file_) return {};
    remove_stale_temporaries(*file_);
    if (resume == Resume::never) {
        remove();
        return {};
    }
    for (const fs::path& file : {*file_, previous(*file_)}) {
        if (!is_there(file)) continue;
        const Result<FilmStateHead> head = read_film_state(file, nullptr);
        if (!head && head.error().code == ExitCode::out_of_memory) return fail(head.error());
        if (!head) {
            log.warn(file.string(), "not used to go on from: " + head.error().message);
            continue;
        }
        const std::string differs = differences_from(*head, head_);
        if (differs.empty()) {
            found_ = file;
            is_newest_whole_ = file == *file_;
            return {};
        }
        return fail(ExitCode::configuration,
                    "E-RESUME-MIX",
                    file.string(),
                    "the checkpoint is of another rendering; these differ: " + differs +
                        "; --resume never starts anew");
    }
    if (resume != Resume::require) return {};
    return fail(ExitCode::io_error,
                "E-RESUME-NONE",
                file_->string(),
                "there is no whole checkpoint to go on from, which --resume require asks for");
}

Result<std::vector<FilmArea>> FilmKeeper::fill(Film& film) {
    {
        const std::scoped_lock lock(using_film_, mutex_);
        film_ = &film;
        head_.width = film.width;
        head_.height = film.height;
    }
    if (!found_) return std::vector<FilmArea>();
    Result<FilmStateHead> head = read_film_state(*found_, &film);
    if (!head) return fail(head.error());
    resumed_ = counters_from_file(head->counters);
    const std::lock_guard lock(mutex_);
    head_.areas = head->areas;
    head_.counters = head->counters;
    saved_ = amount_of(head_);
    saved_fraction_ = fraction_of(head_);
    is_kept_ = true;
    return std::move(head->areas);
}

Result<void> FilmKeeper::begin_passes(const PassFilm& film) {
    const std::scoped_lock lock(using_film_, mutex_);
    head_.width = film.film.width;
    head_.height = film.film.height;
    sums_ = film.sums;
    film_ = &film.film;
    passes_.emplace(film);
    if (!found_) return {};
    bool fits = true;
    const Result<FilmStateHead> head = read_film_sums(
        *found_, film.film, [&](StateReader& in) { fits = film.sums->take(film.work, in); });
    if (!fits) {
        return fail(ExitCode::io_error,
                    "E-PART-DAMAGED",
                    found_->string(),
                    "its tiles are not those of this picture; --resume never starts anew");
    }
    if (!head) return fail(head.error());
    resumed_ = film.sums->counters();
    saved_ = amount_of(head_);
    saved_fraction_ = film.sums->fraction();
    is_kept_ = true;
    return {};
}

void FilmKeeper::add(const FinishedTile& tile) {
    if (sums_ != nullptr) return;
    const ImagePart origin = tile.film->part_of.value_or(ImagePart{});
    const std::array<uint64_t, 6> counters = counters_in_file(tile.counters);
    const std::lock_guard lock(mutex_);
    head_.areas.push_back(
        {tile.area.x - origin.x, tile.area.y - origin.y, tile.area.width, tile.area.height});
    for (size_t i = 0; i < counters.size(); ++i)
        head_.counters[i] += counters[i];
}

void FilmKeeper::leave() {
    const std::lock_guard lock(using_film_);
    film_ = nullptr;
    passes_.reset();
}

Result<bool> FilmKeeper::save_meanwhile() {
    const std::lock_guard lock(using_film_);
    if (film_ == nullptr) return false;
    return save(*film_);
}

Result<bool> FilmKeeper::save(const Film& film) {
    if (!file_) return false;
    const FilmStateHead head = head_so_far();
    const int64_t amount = amount_of(head);
    const double so_far = fraction();
    {
        const std::lock_guard lock(mutex_);
        if (amount == saved_) return false;
    }
    // The older of two generations goes. While the new one is written, the one before it is there
    // under its other name. A damaged one never takes the place of a whole one.
    std::error_code ignored;
    if (is_newest_whole_) fs::rename(*file_, previous(*file_), ignored);
    is_newest_whole_ = false;
    if (auto written = write(head, film); !written) return fail(written.error());
    is_newest_whole_ = true;
    const std::lock_guard lock(mutex_);
    saved_ = amount;
    saved_fraction_ = so_far;
    since_save_.emplace();
    is_kept_ = true;
    return true;
}

Result<void> FilmKeeper::write(const FilmStateHead& head, const Film& film) const {
    if (sums_ == nullptr) return write_film_state(*file_, head, film);
    return write_film_sums(*file_, head, film, [&](StateWriter& out) { sums_->put(out); });
}

void FilmKeeper::remove() const {
    if (!file_) return;
    std::error_code ignored;
    fs::remove(*file_, ignored);
    fs::remove(previous(*file_), ignored);
}

std::optional<Film> FilmKeeper::film_so_far() const {
    const std::lock_guard lock(using_film_);
    if (film_ == nullptr) return {};
    if (passes_) return sums_->film(passes_->work.layers, *film_);
    return copy_areas(*film_, head_so_far().areas);
}

Film FilmKeeper::finished_of(Film&& film) const {
    return sums_ != nullptr ? std::move(film) : copy_areas(film, head_so_far().areas);
}

double FilmKeeper::fraction() const {
    std::shared_ptr<FilmSums> sums;
    {
        const std::lock_guard lock(mutex_);
        sums = sums_;
    }
    if (sums != nullptr) return sums->fraction();
    return fraction_of(head_so_far());
}

double FilmKeeper::saved_fraction() const {
    const std::lock_guard lock(mutex_);
    return saved_fraction_;
}

double FilmKeeper::seconds_since_save() const {
    const std::lock_guard lock(mutex_);
    return since_save_ ? since_save_->seconds() : std::numeric_limits<double>::infinity();
}

std::string FilmKeeper::file_if_kept() const {
    const std::lock_guard lock(mutex_);
    return is_kept_ ? file_->string() : "";
}

/// How much of the film there is: it only grows.
int64_t FilmKeeper::amount_of(const FilmStateHead& head) const {
    return sums_ != nullptr ? sums_->samples() : static_cast<int64_t>(head.areas.size());
}

FilmStateHead FilmKeeper::head_so_far() const {
    const std::lock_guard lock(mutex_);
    return head_;
}

}  // namespace obscura
