// serve/viewer.h - one client's asset: renders what the client wishes to see, again and again.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "session/open_asset.h"

#include "serve/shown_image.h"
#include "serve/view_settings.h"
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

namespace obscura {
class FilmKeeper;
}  // namespace obscura

namespace obscura::serve {

/// What the pixel under a pointer shows.
struct Pick {
    std::string node;  ///< its path, as Cryptomatte names it; empty: nothing is there
    std::string material;
    double distance_m = 0;  ///< from the eye
    Vec3d point_m = {};
};

/// A camera as clients move it.
struct LookAt {
    Vec3d eye_m, target_m, up;
    double yfov_rad = 0;
};

/// Renders in a thread of its own. A new wish ends the rendering of the one before it. The first
/// pictures of a wish are small or noisy; the last one has the bits of `obscura render`. While
/// nobody asks for pictures, nothing is rendered. All but open() may be called from any thread.
class Viewer {
public:
    Viewer(const std::filesystem::path& scene, const gltf::LoadOptions& load);
    ~Viewer();
    Viewer(const Viewer&) = delete;
    Viewer& operator=(const Viewer&) = delete;

    /// Opens the asset and finds the camera of a wish; to be called once, before all else.
    ///
    /// Errors  those of OpenAsset
    Result<LookAt> open(const Wish& wish);
    /// After open(), until the first wish.
    const Scene& scene() { return asset_.renderer().scene(); }
    /// Of opening.
    std::vector<std::string> warnings() const { return opening_.warnings(); }

    void want(Wish wish);

    /// The newest picture later than `after`; waits for it. Null: none came in time.
    std::shared_ptr<const ShownImage> wait_for(int after, std::chrono::milliseconds time);

    /// The picture so far as a file.
    ///
    /// Errors  64 E-VIEW-EMPTY there is none yet; those of encode_output
    Result<EncodedFile> file(const OutputTarget& target);

    /// In      x, y: from the picture's top left corner, in [0, 1]
    /// Errors  64 E-VIEW-EMPTY there was no wish; those of rendering
    Result<Pick> pick(double x, double y);
    /// How much of every pixel a node covers, as Cryptomatte counts it.
    ///
    /// Errors  likewise; 64 E-NODE-UNKNOWN
    Result<DisplayedImage> matte(const std::string& node);

    /// Since a client asked for anything.
    std::chrono::duration<double> idle() const;

private:
    using Clock = std::chrono::steady_clock;

    /// An image that is rendered or finished, with what is needed to show it.
    struct Shown {
        Wish wish;
        ChosenCamera camera;
        std::shared_ptr<const FinishedImage> image;
        std::optional<DisplayTransform> display;
        ShownImage state;  ///< without its image
    };

    void run();
    void render(const Wish& wish);
    Result<void> render_or_show(const Wish& wish);
    Result<void> render_small(const Wish& wish);
    Result<void> render_whole(Shown&& begun);
    void refine(const FilmKeeper& keeper, const std::atomic<bool>& is_over);
    Result<void> show_so_far(const FilmKeeper& keeper, int samples);
    Result<void> show(Shown& shown);
    void publish(ShownImage&& picture);
    bool take_wish_of_display();
    bool is_watched() const;
    Result<ChosenCamera> prepare(const Wish& wish, Log& log);
    Result<FinishedImage> probe(const RenderRequest& asked, std::span<const std::string> layers);
    Result<Pick> pick_now(double x, double y);
    Result<DisplayedImage> matte_now(const std::string& node);
    template <typename T>
    Result<T> on_worker(const std::function<Result<T>()>& task);

    Log opening_;
    OpenAsset asset_;
    double pixels_per_s_ = 2e6;  ///< of small pictures, with all that it takes to show them
    std::mutex showing_;         ///< of `shown_`; locked before mutex_
    Shown shown_;

    mutable std::mutex mutex_;  ///< of what follows
    std::condition_variable wake_, news_;
    Wish wish_;
    bool has_work_ = false;  ///< `wish_` is not shown, or not finished
    std::deque<std::function<void()>> tasks_;
    std::shared_ptr<const ShownImage> image_;
    int serial_ = 0;
    int waiting_ = 0;  ///< clients in wait_for
    Clock::time_point last_asked_ = Clock::now();
    bool ends_ = false;
    std::atomic<bool> stop_ = false;  ///< of the rendering that goes on
    std::thread worker_;
};

}  // namespace obscura::serve
