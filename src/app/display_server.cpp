// app/display_server.cpp - shows images in the viewer tev while they are being rendered.
// SPDX-License-Identifier: Apache-2.0
#include "app/display_server.h"

#include "app/display_canvas.h"
#include "app/display_connection.h"
#include "render/film_sums.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>

namespace obscura::app {

namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

// In the end.
constexpr Seconds longest_standstill{3};
constexpr Seconds longest_wait{15};
constexpr Seconds thread_end_wait{1};
constexpr std::chrono::milliseconds look_period{50};

/// Of images that wait for a slow viewer beside the latest two.
constexpr size_t max_waiting_bytes = 64U << 20U;

PixelRect whole_of(const Film& film) {
    const ImagePart origin = film.part_of.value_or(ImagePart{});
    return {origin.x, origin.y, film.width, film.height};
}

}  // namespace

struct DisplayServer::Shared {
    explicit Shared(const DisplayAddress& to) : address(to) {}

    const DisplayAddress address;
    std::atomic<bool> gives_up = false;
    std::atomic<uint64_t> sent_bytes = 0;
    std::atomic<bool> is_over = false;  ///< the thread has ended, or is about to
    std::mutex mutex;                   ///< of what follows
    std::condition_variable wake;       ///< there is something to send, or no more will come
    std::condition_variable over;
    Log* log = nullptr;     ///< null: its owner does not listen any more
    std::string name;       ///< of the latest image
    bool is_begun = false;  ///< its canvas is the last one
    std::deque<DisplayCanvas> canvases;
    std::vector<int> tile_samples;  ///< of the latest image, as far as they have come
    bool ends = false;
    bool has_dropped = false;

    void put(const Film& film, const PixelRect& area, const PixelSource& source);
    bool is_newest(size_t tile, int samples);
    void drop_oldest();
    std::optional<Bytes> next_packet();
    void end(const std::string& warning);
};

/// To be called with the mutex locked.
///
/// In      film: for the size and channels of the whole
void DisplayServer::Shared::put(const Film& film,
                                const PixelRect& area,
                                const PixelSource& source) {
    if (is_over) return;
    if (!is_begun) {
        canvases.emplace_back(name, film);
        is_begun = true;
        drop_oldest();
    }
    canvases.back().put(area, source);
    wake.notify_one();
}

/// Two threads may come with the same tile of two passes, in any order.
bool DisplayServer::Shared::is_newest(size_t tile, int samples) {
    if (tile_samples.size() <= tile) tile_samples.resize(tile + 1, 0);
    if (samples < tile_samples[tile]) return false;
    tile_samples[tile] = samples;
    return true;
}

/// Keeps the memory of images that the viewer has not seen in bounds.
void DisplayServer::Shared::drop_oldest() {
    size_t waiting = 0;
    for (size_t i = 0; i + 2 < canvases.size(); ++i)
        waiting += canvases[i].bytes();
    while (waiting > max_waiting_bytes) {
        waiting -= canvases.front().bytes();
        canvases.pop_front();
        if (!has_dropped && log != nullptr) {
            log->warn(text_of(address),
                      "the viewer is slower than rendering: some pictures stay unfinished there");
        }
        has_dropped = true;
    }
}

/// Earlier images first; those that the viewer has seen go, but for the latest one.
std::optional<Bytes> DisplayServer::Shared::next_packet() {
    while (!canvases.empty()) {
        if (canvases.front().has_changes()) return canvases.front().take_packet();
        if (canvases.size() == 1 && is_begun) return {};
        canvases.pop_front();
    }
    return {};
}

void DisplayServer::Shared::end(const std::string& warning) {
    const std::lock_guard lock(mutex);
    if (!warning.empty() && !gives_up && log != nullptr) log->warn(text_of(address), warning);
    canvases.clear();
    is_over = true;
    over.notify_all();
}

DisplayServer::DisplayServer(const DisplayAddress& address, Log& log)
    : shared_(std::make_shared<Shared>(address)) {
    shared_->log = &log;
    thread_ = std::thread([shared = shared_] { run(shared); });
}

DisplayServer::~DisplayServer() {
    finish(true);
}

void DisplayServer::run(const std::shared_ptr<Shared>& shared) {
    DisplayConnection connection(shared->gives_up);
    if (const std::string reason = connection.open(shared->address); !reason.empty()) {
        shared->end("the viewer cannot be reached: " + reason + "; rendering goes on without it");
        return;
    }
    while (true) {
        std::optional<Bytes> packet;
        {
            std::unique_lock lock(shared->mutex);
            shared->wake.wait(lock, [&] {
                packet = shared->next_packet();
                return packet || shared->ends;
            });
        }
        if (!packet) break;
        const std::string reason = connection.send(*packet, shared->sent_bytes);
        if (reason.empty()) continue;
        shared->end("the viewer is lost: " + reason + "; rendering goes on without it");
        return;
    }
    shared->end("");
}

void DisplayServer::begin_image(const std::string& name) {
    const std::lock_guard lock(shared_->mutex);
    shared_->name = name;
    shared_->tile_samples.clear();
    shared_->is_begun = false;
}

void DisplayServer::add(const FinishedTile& tile) {
    if (shared_->is_over) return;
    if (tile.sums == nullptr) {
        add(*tile.film, tile.area);
        return;
    }
    const FilmSums::TileSoFar so_far = tile.sums->beauty_of(tile.index, *tile.film);
    const Film& pixels = so_far.film;
    const std::lock_guard lock(shared_->mutex);
    if (!shared_->is_newest(tile.index, so_far.samples)) return;
    shared_->put(*tile.film, tile.area, {pixels.part_of, pixels.width, pixels.pixels.data()});
}

void DisplayServer::add(const Film& film, const PixelRect& area) {
    const std::lock_guard lock(shared_->mutex);
    shared_->put(film, area, {film.part_of, film.width, film.pixels.data()});
}

void DisplayServer::add(const OutputImage& image) {
    const Film shape{image.width, image.height, image.channels, {}, image.part_of};
    const std::lock_guard lock(shared_->mutex);
    shared_->put(shape, whole_of(shape), {image.part_of, image.width, image.pixels.data()});
}

void DisplayServer::finish(bool at_once) {
    if (!thread_.joinable()) return;
    std::unique_lock lock(shared_->mutex);
    shared_->ends = true;
    shared_->wake.notify_one();
    const auto begin = Clock::now();
    auto moved = begin;
    uint64_t sent = shared_->sent_bytes;
    while (!shared_->is_over) {
        const auto now = Clock::now();
        if (sent != shared_->sent_bytes) moved = now;
        sent = shared_->sent_bytes;
        if (at_once || now - moved > longest_standstill || now - begin > longest_wait) {
            if (!at_once) {
                shared_->log->warn(text_of(shared_->address),
                                   "the viewer takes the rest of the picture too slowly; it is "
                                   "left out there");
            }
            shared_->gives_up = true;
            break;
        }
        shared_->over.wait_for(lock, look_period);
    }
    const bool has_ended =
        shared_->over.wait_for(lock, thread_end_wait, [&] { return shared_->is_over.load(); });
    shared_->log = nullptr;
    lock.unlock();
    if (has_ended) {
        thread_.join();
    } else {
        thread_.detach();  // it looks up a name, and touches nothing but what it owns
    }
}

}  // namespace obscura::app
