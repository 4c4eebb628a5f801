// serve/viewer.cpp - one client's asset: takes wishes and hands out pictures.
// SPDX-License-Identifier: Apache-2.0
#include "serve/viewer.h"

#include "base/parallel.h"

#include "serve/guarded.h"
#include <future>

namespace obscura::serve {

namespace {

/// Nobody has asked for a picture for so long: nobody looks.
constexpr std::chrono::seconds patience(3);

tl::unexpected<Error> nothing_there() {
    return fail(ExitCode::usage, "E-VIEW-EMPTY", "view", "there is no picture yet");
}

LookAt look_of(const ChosenCamera& camera, const Scene& scene) {
    const auto& m = camera.basis.world_from_camera.m;
    const auto column = [&](size_t i) { return Vec3d{m[0][i], m[1][i], m[2][i]}; };
    LookAt out;
    out.eye_m = column(3);
    out.up = {0, 1, 0};
    const Vec3d ahead = -1.0 * column(2);
    if (std::abs(dot(ahead, out.up)) > 0.999) out.up = column(1);
    const BoundingSphere ball = bounding_sphere(scene.bounds);
    const double to_middle = dot(ball.centre_m - out.eye_m, ahead);
    out.target_m = out.eye_m + std::max(to_middle, 0.1 * ball.radius_m) * ahead;
    out.yfov_rad = 2 * std::atan(camera.basis.tan_half_yfov);
    return out;
}

}  // namespace

Viewer::Viewer(const std::filesystem::path& scene, const gltf::LoadOptions& load)
    : asset_(scene, load) {}

Viewer::~Viewer() {
    {
        const std::lock_guard lock(mutex_);
        ends_ = true;
        stop_ = true;
    }
    wake_.notify_all();
    if (worker_.joinable()) worker_.join();
}

Result<LookAt> Viewer::open(const Wish& wish) {
    return guarded<LookAt>([&]() -> Result<LookAt> {
        const ThreadArena threads(wish.request.threads);
        const Result<ChosenCamera> camera = prepare(wish, opening_);
        if (!camera) return fail(camera.error());
        return look_of(*camera, asset_.renderer().scene());
    });
}

void Viewer::want(Wish wish) {
    const std::lock_guard lock(mutex_);
    if (wish.number < wish_.number) return;  // two came at once, and the later one was here first
    // What only changes how samples are shown does not end the rendering: see refine().
    if (wish.rendering != wish_.rendering) stop_ = true;
    wish_ = std::move(wish);
    has_work_ = true;
    last_asked_ = Clock::now();
    if (!worker_.joinable()) worker_ = std::thread([this] { run(); });
    wake_.notify_all();
}

std::shared_ptr<const ShownImage> Viewer::wait_for(int after, std::chrono::milliseconds time) {
    std::unique_lock lock(mutex_);
    ++waiting_;
    wake_.notify_all();
    news_.wait_for(lock, time, [&] { return image_ && image_->serial > after; });
    --waiting_;
    last_asked_ = Clock::now();
    return image_ && image_->serial > after ? image_ : nullptr;
}

Result<EncodedFile> Viewer::file(const OutputTarget& target) {
    return guarded<EncodedFile>([&]() -> Result<EncodedFile> {
        const std::lock_guard lock(showing_);
        if (!shown_.image) return nothing_there();
        return encode_output(shown_.wish.request, *shown_.image, target, shown_.display);
    });
}

/// Between two renderings, or breaking one off: that one is begun again.
template <typename T>
Result<T> Viewer::on_worker(const std::function<Result<T>()>& task) {
    std::promise<Result<T>> answer;
    std::future<Result<T>> given = answer.get_future();
    {
        const std::lock_guard lock(mutex_);
        if (!worker_.joinable()) return nothing_there();
        tasks_.emplace_back([&] { answer.set_value(guarded<T>(task)); });
        stop_ = true;
        last_asked_ = Clock::now();
    }
    wake_.notify_all();
    return given.get();
}

Result<Pick> Viewer::pick(double x, double y) {
    return on_worker<Pick>([=, this] { return pick_now(x, y); });
}

Result<DisplayedImage> Viewer::matte(const std::string& node) {
    return on_worker<DisplayedImage>([&] { return matte_now(node); });
}

std::chrono::duration<double> Viewer::idle() const {
    const std::lock_guard lock(mutex_);
    if (waiting_ > 0) return {};
    return Clock::now() - last_asked_;
}

/// With mutex_ locked.
bool Viewer::is_watched() const {
    return waiting_ > 0 || Clock::now() - last_asked_ < patience;
}

void Viewer::run() {
    std::unique_lock lock(mutex_);
    while (true) {
        wake_.wait(lock, [&] { return ends_ || !tasks_.empty() || (has_work_ && is_watched()); });
        if (ends_) return;
        stop_ = false;
        std::function<void()> task;
        Wish wish;
        if (!tasks_.empty()) {
            task = std::move(tasks_.front());
            tasks_.pop_front();
        } else {
            wish = wish_;
            has_work_ = false;
        }
        lock.unlock();
        if (task) {
            task();
        } else {
            render(wish);
        }
        lock.lock();
    }
}

void Viewer::render(const Wish& wish) {
    const ThreadArena threads(wish.request.threads);
    const Result<void> done = guarded<void>([&] { return render_or_show(wish); });
    if (done) return;
    ShownImage failure;
    failure.wish = wish.number;
    failure.seconds = wish.seconds();
    failure.error = done.error();
    publish(std::move(failure));
}

void Viewer::publish(ShownImage&& picture) {
    const std::lock_guard lock(mutex_);
    // A rendering that was begun again first has to come as far as the one before it.
    const bool is_behind = image_ && image_->wish == picture.wish && !picture.error &&
                           picture.samples < image_->samples;
    if (is_behind) return;
    picture.serial = ++serial_;
    image_ = std::make_shared<const ShownImage>(std::move(picture));
    news_.notify_all();
}

}  // namespace obscura::serve
