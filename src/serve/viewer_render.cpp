// serve/viewer_render.cpp - how a viewer renders: small at first, then in passes over the picture.
// SPDX-License-Identifier: Apache-2.0
#include "film/cryptomatte.h"
#include "film/cryptomatte_names.h"
#include "image/channel_planes.h"
#include "render/integrators.h"
#include "session/denoising.h"
#include "session/film_keeper.h"
#include "session/smaller_image.h"

#include "serve/beside.h"
#include "serve/viewer.h"
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace obscura::serve {

namespace {

/// A moving view shows its first picture within 0.1 s, with the client's share in it.
constexpr double first_image_s = 0.05;

/// As many samples as all pixels must have before the next picture is worth its time.
int next_samples(int samples) {
    return samples < 1 ? 1 : samples * 2;
}

/// The first pixel of a layer.
double value_of(const FinishedImage& image, std::string_view layer, size_t channel) {
    for (const ImageLayer& one : image.image.layers) {
        if (one.name == layer) return static_cast<double>(one.pixels[channel]);
    }
    return 0;
}

}  // namespace

Result<ChosenCamera> Viewer::prepare(const Wish& wish, Log& log) {
    const RenderRequest& request = wish.request;
    if (auto loaded = asset_.load_as(request.load, log); !loaded) return fail(loaded.error());
    return asset_.prepare(request, {request.load.time_s, {}}, log);
}

/// Samples that are there already are only shown.
Result<void> Viewer::render_or_show(const Wish& wish) {
    {
        const std::lock_guard lock(showing_);
        const bool is_rendered = shown_.state.is_done && shown_.wish.rendering == wish.rendering;
        if (is_rendered) {
            shown_.wish = wish;
            shown_.display.reset();
            return show(shown_);
        }
    }
    Log log;
    Shown begun{wish, {}, {}, {}, {}};
    Result<ChosenCamera> camera = prepare(wish, log);
    if (!camera) return fail(camera.error());
    begun.camera = std::move(*camera);
    begun.state.wish = wish.number;
    begun.state.of = samples_taken(wish.request.options);
    if (auto small = render_small(wish); !small) return small;
    return render_whole(std::move(begun));
}

/// Not broken off by the next wish: while a view moves, there is always something to see.
Result<void> Viewer::render_small(const Wish& wish) {
    const RenderOptions& options = wish.request.options;
    const double seconds = double{1} * options.width * options.height / pixels_per_s_;
    const int factor = static_cast<int>(std::ceil(std::sqrt(seconds / first_image_s)));
    if (factor < 2) return {};
    const auto begin = Clock::now();
    Shown small;
    small.wish = {wish.number, smaller_image(wish.request, std::min(factor, 8), 1), "", wish.since};
    small.state.wish = wish.number;
    small.state.of = samples_taken(options);
    Log log;
    Result<ChosenCamera> camera = asset_.renderer().look_again(small.wish.request, log);
    if (!camera) return fail(camera.error());
    small.camera = std::move(*camera);
    Result<FinishedImage> image =
        asset_.renderer().render(small.wish.request, small.camera, {}, log);
    if (!image) return fail(image.error());
    const double pixels = double{1} * image->image.width * image->image.height;
    small.image = std::make_shared<const FinishedImage>(std::move(*image));
    const Result<void> done = show(small);
    const std::chrono::duration<double> taken = Clock::now() - begin;
    pixels_per_s_ = 0.5 * (pixels_per_s_ + pixels / std::max(taken.count(), 1e-4));
    return done;
}

Result<void> Viewer::render_whole(Shown&& begun) {
    const RenderRequest request = begun.wish.request;
    const ChosenCamera camera = begun.camera;
    FilmStateHead head;
    head.target_samples = samples_taken(request.options);
    head.is_adaptive = request.options.adaptive.has_value();
    {
        const std::lock_guard lock(showing_);
        shown_ = std::move(begun);
    }
    FilmKeeper keeper(std::move(head), {});
    FilmShare share;
    share.part = FilmPart{};
    share.fill = [&](Film& film) { return keeper.fill(film); };
    share.begin_passes = [&](const PassFilm& film) { return keeper.begin_passes(film); };
    share.shows_early = true;
    share.wants_film = [&] { return !stop_; };
    share.leave = [&](const Film& /*film*/) { keeper.leave(); };
    const RenderHooks hooks{[&](const FinishedTile& tile) { keeper.add(tile); }, &stop_, &share};
    Result<RenderedFilm> film = [&] {
        const Beside beside(
            [&](const std::atomic<bool>& is_over) { return refine(keeper, is_over); });
        return asset_.renderer().render_film(request, camera, hooks);
    }();
    if (!film && film.error().id == "E-STOPPED") {
        const std::lock_guard lock(mutex_);
        has_work_ = true;
        return {};
    }
    if (!film) return fail(film.error());
    Log log;
    const std::lock_guard lock(showing_);
    FinishedImage image = asset_.renderer().finish(request, camera, std::move(*film), log);
    shown_.image = std::make_shared<const FinishedImage>(std::move(image));
    shown_.state.samples = shown_.state.of;
    shown_.state.is_done = true;
    shown_.state.is_denoised = request.denoise;
    return show(shown_);
}

/// Beside the rendering: shows the picture so far when it is worth it, and ends the rendering when
/// nobody looks any more.
void Viewer::refine(const FilmKeeper& keeper, const std::atomic<bool>& is_over) {
    constexpr std::chrono::milliseconds interval(5);
    int due = next_samples(0);
    while (!is_over) {
        std::this_thread::sleep_for(interval);
        const bool has_sums = keeper.fraction() > 0 && keeper.sums() != nullptr;
        const int samples = has_sums ? keeper.sums()->min_samples() : 0;
        const int target = has_sums ? keeper.sums()->target() : 0;  // shown when all is done
        const bool is_shown_anew = take_wish_of_display();
        {
            const std::lock_guard lock(mutex_);
            if (!is_watched()) stop_ = true;
        }
        if (is_over || stop_) return;
        const bool is_worth_it = samples >= due && samples < target;
        if (!is_worth_it && !(is_shown_anew && samples > 0)) continue;
        // Where there is no memory for it, or no display, the finished picture's error says so.
        const Result<void> shown = show_so_far(keeper, samples);
        if (!shown) return;
        due = next_samples(samples);
    }
}

/// A wish for other colours of the same samples.
bool Viewer::take_wish_of_display() {
    const std::scoped_lock lock(showing_, mutex_);
    const bool is_taken = has_work_ && wish_.rendering == shown_.wish.rendering;
    if (!is_taken) return false;
    has_work_ = false;
    shown_.wish = wish_;
    shown_.state.wish = wish_.number;
    shown_.display.reset();
    return true;
}

Result<void> Viewer::show_so_far(const FilmKeeper& keeper, int samples) {
    std::optional<Film> film = keeper.film_so_far();
    if (!film) return {};
    const std::lock_guard lock(showing_);
    RenderRequest request = shown_.wish.request;
    request.denoise = false;
    remove_denoising_layers(request.options, *film);
    RenderedFilm rendered{request.options, {}};
    rendered.result.film = std::move(*film);
    Log log;
    FinishedImage image =
        asset_.renderer().finish(request, shown_.camera, std::move(rendered), log);
    shown_.image = std::make_shared<const FinishedImage>(std::move(image));
    shown_.state.samples = samples;
    return show(shown_);
}

/// With showing_ locked where `shown` is the member.
Result<void> Viewer::show(Shown& shown) {
    const RenderRequest& request = shown.wish.request;
    if (!shown.display) {
        Log log;
        Result<std::optional<DisplayTransform>> display = make_display(request, log);
        if (!display) return fail(display.error());
        if (auto exposed = expose_display(shown.camera, request, *display, log); !exposed)
            return exposed;
        shown.display = std::move(*display);
    }
    ShownImage picture = shown.state;
    picture.wish = shown.wish.number;
    picture.seconds = shown.wish.seconds();
    picture.image = displayed_image(request, *shown.image, shown.display);
    publish(std::move(picture));
    return {};
}

/// Renders what is not shown: other layers of the same view.
Result<FinishedImage> Viewer::probe(const RenderRequest& asked,
                                    std::span<const std::string> layers) {
    RenderRequest request = asked;
    request.options.integrator = Integrator::raycast;
    request.options.adaptive.reset();
    request.options.layers.clear();
    request.denoise = false;
    if (auto chosen = choose_layers(layers, request); !chosen) return fail(chosen.error());
    Log log;
    const Result<ChosenCamera> camera = prepare({0, request, ""}, log);
    if (!camera) return fail(camera.error());
    return asset_.renderer().render(request, *camera, {}, log);
}

Result<Pick> Viewer::pick_now(double x, double y) {
    RenderRequest request;
    {
        const std::lock_guard lock(mutex_);
        request = wish_.request;
    }
    RenderOptions& options = request.options;
    const auto pixel = [](double part, int count) {
        return std::clamp(static_cast<int>(part * count), 0, count - 1);
    };
    options.crop = PixelRect{pixel(x, options.width), pixel(y, options.height), 1, 1};
    options.samples_per_pixel = 1;
    const std::array<std::string, 4> layers = {"id_node", "id_material", "distance", "position"};
    const Result<FinishedImage> image = probe(request, layers);
    if (!image) return fail(image.error());
    Pick out;
    const auto id = [&](std::string_view layer) {
        return static_cast<size_t>(value_of(*image, layer, 0));
    };
    if (id("id_node") == 0) return out;
    const CryptomatteTables names = cryptomatte_tables(asset_.renderer().scene());
    out.node = names.objects.at(id("id_node"));
    out.material = names.materials.at(id("id_material"));
    out.distance_m = value_of(*image, "distance", 0);
    out.point_m = {value_of(*image, "position", 0),
                   value_of(*image, "position", 1),
                   value_of(*image, "position", 2)};
    return out;
}

Result<DisplayedImage> Viewer::matte_now(const std::string& node) {
    constexpr int enough_samples = 16;
    RenderRequest request;
    {
        const std::lock_guard lock(mutex_);
        request = wish_.request;
    }
    int& samples = request.options.samples_per_pixel;
    samples = std::min(samples, enough_samples);
    const std::array<std::string, 1> layers = {"crypto_object"};
    const Result<FinishedImage> image = probe(request, layers);
    if (!image) return fail(image.error());
    const ImageLayer& layer = image->image.layers.front();
    const auto known = std::find(layer.names.begin(), layer.names.end(), node);
    if (known == layer.names.end())
        return fail(ExitCode::usage, "E-NODE-UNKNOWN", node, "no surface of that node is there");
    const float id = cryptomatte_id(cryptomatte_hash(node));
    const size_t channels = layer.channels.size();
    std::vector<float> covered(layer.pixels.size() / channels);
    for_planes(channels, covered.size(), [&](const ChannelPlane& plane) {
        const float* ranks = layer.pixels.data() + plane.first_value;
        for (float& sum : covered) {
            for (size_t rank = 0; rank < plane.channels; rank += 2, ranks += 2) {
                if (std::bit_cast<uint32_t>(ranks[0]) == std::bit_cast<uint32_t>(id))
                    sum += ranks[1];
            }
        }
    });
    DisplayedImage out{image->image.width, image->image.height, 1, {}};
    for (const float part : covered)
        out.codes.push_back(static_cast<uint8_t>(std::lround(255 * std::clamp(part, 0.0f, 1.0f))));
    return out;
}

}  // namespace obscura::serve
