// tests/render/pass_sums_test.cpp - passes over a film: the bits of one pass, whole at any moment.
// SPDX-License-Identifier: Apache-2.0
#include "render/pass_sums.h"

#include "base/parallel.h"
#include "film/light_path_expression.h"

#include <gtest/gtest.h>

#include "support/scene_builder.h"
#include <functional>

namespace obscura::test {
namespace {

/// A ball on a floor that catches shadows, below a lamp and a faint sky.
PreparedScene ball() {
    SceneBuilder builder;
    Material lamp;
    std::fill_n(lamp.emission, 3, 20.0f);
    const int32_t grey = builder.material({});
    builder.quad({-3, 0, -3}, {0, 0, 6}, {6, 0, 0}, grey);
    builder.sphere({0, 0.7f, 0}, 0.7f, 12, grey);
    builder.quad({-1.5f, 2.5f, -0.4f}, {0.8f, 0, 0}, {0, 0, 0.8f}, builder.material(lamp));
    // Mirrors, so small that they are in few samples of their tiles.
    Material mirror;
    mirror.roughness = 0;
    std::fill_n(mirror.base_color, 3, 0.5f);
    const int32_t shines = builder.material(mirror);
    for (const float x : {-1.7f, -1.1f, 1.0f, 1.5f})
        builder.sphere({x, 1.1f + 0.1f * x, 0.5f}, 0.02f, 12, shines);
    LightingOptions light;
    light.environment = constant_environment(0.2f);
    Log log(Verbosity::quiet);
    return PreparedScene::create(builder.take(), light, Isa::automatic, log).value();
}

class PassesOfAFilm : public testing::Test {
protected:
    static RenderOptions options(int samples) {
        const std::vector<std::string> names = {"sample_count",
                                                "variance",
                                                "normal",
                                                "depth",
                                                "crypto_object",
                                                "diffuse_direct",
                                                "shadow",
                                                "cost"};
        RenderOptions out;
        out.width = 71;
        out.height = 45;
        out.max_bounces = 3;
        out.samples_per_pixel = samples;
        out.catcher_ground_m = -0.5f;
        out.light_groups.each = true;
        out.layers = layers_of(names, 2).value();
        out.layers.push_back(
            light_layer("mirrors", parse_light_path_expression("C<RS>.*[LOB]").value()));
        return out;
    }
    RenderResult render_with(const RenderOptions& options, double stop_at = 2) const {
        std::atomic<bool> stop = false;
        const auto progress = [&](const FinishedTile& tile) {
            if (tile.done > stop_at) stop = true;
        };
        const Camera camera =
            look_at({0, 1.5f, 5}, {0, 0.9f, 0}, 0.8f, options.width, options.height);
        return render(scene_, camera, options, progress, stop).value();
    }
    /// Renders in passes, after `begin`; they stay in `sums_`.
    RenderResult render_passes_of(RenderOptions options,
                                  const std::function<void(const PassFilm&)>& begin,
                                  double stop_at = 2,
                                  const FilmPart& part = {}) {
        FilmShare share{part};
        share.wants_film = [=] { return part.of == PartOf::rows; };
        share.keeps_unfinished = true;
        share.shows_early = shows_early_;
        share.begin_passes = [&](const PassFilm& film) -> Result<void> {
            sums_ = film.sums;
            begin(film);
            return {};
        };
        options.share = &share;
        return render_with(options, stop_at);
    }
    std::string bytes() const {
        std::string out;
        const ByteSink sink = [&](std::span<const std::byte> piece) -> Result<void> {
            out.append(reinterpret_cast<const char*>(piece.data()), piece.size());
            return {};
        };
        StateWriter writer(sink);
        sums_->put(writer);
        EXPECT_TRUE(writer.finish());
        return out;
    }
    static void expect_same(const Film& a, const Film& b) {
        EXPECT_TRUE(std::equal(a.pixels.begin(), a.pixels.end(), b.pixels.begin(), b.pixels.end()));
        ASSERT_EQ(a.layers.size(), b.layers.size());
        for (size_t k = 0; k < a.layers.size(); ++k) {
            const UnsetArray<float>& one = a.layers[k].pixels;
            const UnsetArray<float>& two = b.layers[k].pixels;
            EXPECT_TRUE(std::equal(one.begin(), one.end(), two.begin(), two.end()))
                << a.layers[k].layer.name;
        }
    }
    static void nothing(const PassFilm& /*film*/) {}

    const PreparedScene scene_ = ball();
    std::shared_ptr<FilmSums> sums_;
    bool shows_early_ = true;
};

TEST(PassEnds, AreShortAtFirstAndEndWithAllSamples) {
    EXPECT_EQ(pass_ends(1, true), (std::vector<int>{1}));
    EXPECT_EQ(pass_ends(3, true), (std::vector<int>{1, 3}));
    EXPECT_EQ(pass_ends(4, true), (std::vector<int>{1, 4}));
    EXPECT_EQ(pass_ends(50, true), (std::vector<int>{1, 4, 16, 50}));
    EXPECT_EQ(pass_ends(200, true), (std::vector<int>{1, 4, 16, 64, 128, 192, 200}));
    const std::vector<int> many = pass_ends(1'000'000, true);
    EXPECT_LT(many.size(), 250u);
    EXPECT_EQ(many.back(), 1'000'000);
    for (size_t i = 3; i + 1 < many.size(); ++i) {
        EXPECT_EQ(many[i] % 16, 0);
        EXPECT_LE(many[i + 1] - many[i], std::max(64, many[i] / 16));
    }
    EXPECT_EQ(pass_ends(INT32_MAX, true).back(), INT32_MAX);
}

TEST(PassEnds, AreFewerWhereNobodyLooksEarly) {
    EXPECT_EQ(pass_ends(1, false), (std::vector<int>{1}));
    EXPECT_EQ(pass_ends(50, false), (std::vector<int>{50}));
    EXPECT_EQ(pass_ends(200, false), (std::vector<int>{64, 128, 192, 200}));
    const std::vector<int> early = pass_ends(1'000'000, true);
    const std::vector<int> late = pass_ends(1'000'000, false);
    EXPECT_TRUE(std::equal(early.begin() + 3, early.end(), late.begin(), late.end()));
}

TEST_F(PassesOfAFilm, HaveTheBitsOfOnePass) {
    for (const int samples : {1, 37, 100}) {
        const RenderResult at_once = render_with(options(samples));
        for (const int threads : {1, 4}) {
            shows_early_ = threads == 1;
            const ThreadLimit limit(threads);
            const RenderResult passes = render_passes_of(options(samples), nothing);
            expect_same(at_once.film, passes.film);
            EXPECT_FALSE(passes.is_stopped);
            EXPECT_EQ(at_once.counters.paths, passes.counters.paths);
            EXPECT_EQ(sums_->counters().shadow_rays, at_once.counters.shadow_rays);
            EXPECT_EQ(sums_->fraction(), 1);
            EXPECT_EQ(sums_->min_samples(), samples);
        }
    }
}

TEST_F(PassesOfAFilm, AreThatOfFewerSamplesInBetween) {
    const ThreadLimit one(1);  // so that the stop comes at the end of a pass
    const RenderResult fewer = render_with(options(64));
    const RenderResult stopped = render_passes_of(options(128), nothing, 63.9 / 128);
    EXPECT_TRUE(stopped.is_stopped);
    EXPECT_EQ(sums_->min_samples(), 64);
    EXPECT_EQ(sums_->mean_samples(), 64);
    EXPECT_EQ(sums_->fraction(), 0.5);
    expect_same(fewer.film, stopped.film);
}

TEST_F(PassesOfAFilm, AreBlackWhereNothingIsYet) {
    const ThreadLimit one(1);
    const RenderResult stopped = render_passes_of(options(64), nothing, 0);
    EXPECT_EQ(sums_->min_samples(), 0);
    EXPECT_GT(stopped.film.pixels[3], 0);
    const auto last = stopped.film.pixels.end() - 4;
    EXPECT_EQ(std::count(last, last + 4, 0.0f), 4);
}

TEST_F(PassesOfAFilm, GoOnToTheSameBitsFromTheirBytes) {
    for (const double stop_at : {0.0, 0.1, 0.7}) {
        render_passes_of(options(70), nothing, stop_at);
        const int64_t done = sums_->samples();
        EXPECT_LT(sums_->fraction(), 1);
        const std::string kept = bytes();
        // More samples than were asked for at first, too.
        for (const int samples : {70, 90}) {
            const auto take = [&](const PassFilm& film) {
                StateReader reader(std::as_bytes(std::span(kept)));
                EXPECT_TRUE(film.sums->take(film.work, reader));
                EXPECT_EQ(film.sums->samples(), done);
            };
            const RenderResult resumed = render_passes_of(options(samples), take);
            expect_same(render_with(options(samples)).film, resumed.film);
        }
    }
}

TEST_F(PassesOfAFilm, GoOnToTheSameBitsWhereTheyDecideOverSamples) {
    RenderOptions asked = options(256);
    asked.adaptive = AdaptiveOptions{.noise_target = 0.03, .min_samples = 8};
    const RenderResult whole = render_with(asked);
    ASSERT_EQ(whole.adaptive->least, 8);
    ASSERT_GT(whole.adaptive->most, 32) << "the test is to see several passes";
    for (const double stop_at : {0.0, 0.3, 0.4, 0.55, 0.7}) {
        const ThreadLimit two(2);
        const RenderResult stopped = render_passes_of(asked, nothing, stop_at);
        EXPECT_TRUE(stopped.is_stopped);
        EXPECT_EQ(stopped.adaptive->noise.has_value(), stop_at > 0.2) << "after a pass";
        EXPECT_LT(sums_->fraction(), 1);
        EXPECT_EQ(sums_->samples(), static_cast<int64_t>(stopped.adaptive->total));
        const std::string kept = bytes();
        const auto take = [&](const PassFilm& film) {
            StateReader reader(std::as_bytes(std::span(kept)));
            EXPECT_TRUE(film.sums->take(film.work, reader));
            EXPECT_EQ(film.sums->samples(), static_cast<int64_t>(stopped.adaptive->total));
        };
        const RenderResult resumed = render_passes_of(asked, take);
        expect_same(whole.film, resumed.film);
        EXPECT_EQ(sums_->counters().paths, whole.counters.paths);
        EXPECT_EQ(resumed.adaptive->noise, whole.adaptive->noise);
        EXPECT_EQ(resumed.adaptive->total, whole.adaptive->total);
        EXPECT_EQ(resumed.adaptive->passes, whole.adaptive->passes);
        EXPECT_EQ(sums_->fraction(), 1);
    }
    const std::string finished = bytes();
    const RenderResult again = render_passes_of(asked, [&](const PassFilm& film) {
        StateReader reader(std::as_bytes(std::span(finished)));
        EXPECT_TRUE(film.sums->take(film.work, reader));
    });
    EXPECT_EQ(again.counters.paths, 0u) << "nothing is left to be sampled";
    expect_same(whole.film, again.film);
}

/// A block of pixels in the corner may be a single one: then a group of pixels has none.
TEST_F(PassesOfAFilm, GoOnToTheSameBitsWhereTheCornerIsOnePixel) {
    for (const auto& [width, height] : {std::pair{9, 9}, std::pair{17, 9}, std::pair{1, 1}}) {
        RenderOptions asked = options(512);
        asked.width = width;
        asked.height = height;
        asked.adaptive = AdaptiveOptions{.noise_target = 0.01, .min_samples = 128};
        const RenderResult whole = render_with(asked);
        ASSERT_GE(whole.adaptive->least, 128);
        const auto stopped = render_passes_of(asked, nothing, 0.0);
        EXPECT_LE(stopped.adaptive->total, whole.adaptive->total);
        const std::string kept = bytes();
        const RenderResult resumed = render_passes_of(asked, [&](const PassFilm& film) {
            StateReader reader(std::as_bytes(std::span(kept)));
            EXPECT_TRUE(film.sums->take(film.work, reader));
        });
        expect_same(whole.film, resumed.film);
        EXPECT_EQ(resumed.adaptive->total, whole.adaptive->total);
    }
}

TEST_F(PassesOfAFilm, AreNotOverBeforeItIsKnownThatNoneFollows) {
    RenderOptions asked = options(24);
    asked.adaptive = AdaptiveOptions{.noise_target = 0.02, .min_samples = 16};
    ASSERT_GT(render_with(asked).adaptive->passes, 2) << "more than there are levels";
    const RenderResult stopped = render_passes_of(asked, nothing, 0.98);
    EXPECT_TRUE(stopped.is_stopped);
    EXPECT_LT(sums_->fraction(), 1);
}

TEST_F(PassesOfAFilm, OfSomeSamplesAddUpToTheBitsOfAll) {
    constexpr int samples = 87;  // the last block is not whole
    const RenderResult whole = render_with(options(samples));
    for (const int count : {1, 3, 7}) {
        std::vector<std::string> parts;
        for (int index = 0; index < count; ++index) {
            const FilmPart part{index, count, PartOf::samples};
            // One is stopped, and goes on from its bytes.
            if (index == 1) {
                render_passes_of(options(samples), nothing, 0.4, part);
                EXPECT_LT(sums_->fraction(), 1);
            }
            const std::string kept = index == 1 ? bytes() : "";
            const auto go_on = [&](const PassFilm& film) {
                StateReader reader(std::as_bytes(std::span(kept)));
                EXPECT_TRUE(kept.empty() || film.sums->take(film.work, reader));
            };
            render_passes_of(options(samples), go_on, 2, part);
            EXPECT_EQ(sums_->fraction(), 1);
            parts.push_back(bytes());
        }
        const auto append = [&](const PassFilm& film, int index, const std::string& part) {
            StateReader reader(std::as_bytes(std::span(part)));
            const SampleRange own = samples_of_part(samples, {index, count, PartOf::samples});
            return film.sums->append(film.work, own, reader);
        };
        const auto add_in_order = [&](const PassFilm& film) {
            for (int index = 0; index < count; ++index)
                EXPECT_TRUE(append(film, index, parts[static_cast<size_t>(index)]));
            EXPECT_EQ(film.sums->min_samples(), samples);
        };
        const RenderResult merged = render_passes_of(options(samples), add_in_order);
        EXPECT_EQ(merged.counters.paths, 0u) << "nothing is left to be sampled";
        expect_same(whole.film, merged.film);
        if (count > 1) {
            render_passes_of(options(samples), [&](const PassFilm& film) {
                EXPECT_FALSE(append(film, count - 1, parts.back())) << "others come first";
            });
        }
    }
}

TEST_F(PassesOfAFilm, FinishedTilesAreShownAsTheyAre) {
    RenderOptions asked = options(20);
    asked.crop = PixelRect{5, 3, 60, 40};
    FilmShare share{FilmPart{}};
    share.begin_passes = [](const PassFilm& /*film*/) { return Result<void>(); };
    share.shows_early = true;
    asked.share = &share;
    const ThreadLimit limit(1);
    Film shown{
        60, 40, {"R", "G", "B", "A"}, zero_array<float>(60 * 40 * 4), ImagePart{71, 45, 5, 3}};
    int calls = 0;
    const auto progress = [&](const FinishedTile& tile) {
        const auto [film, samples] = tile.sums->beauty_of(tile.index, *tile.film);
        EXPECT_EQ(film.width, tile.area.width);
        EXPECT_EQ(film.part_of->y, tile.area.y);
        for (int y = tile.area.y; y < tile.area.y + film.height; ++y)
            std::copy_n(film.pixels.data() + 4 * pixel_index(film, tile.area.x, y),
                        4 * film.width,
                        shown.pixels.data() + 4 * pixel_index(shown, tile.area.x, y));
        ++calls;
        EXPECT_EQ(samples, pass_ends(20, true)[static_cast<size_t>((calls - 1) / 4)]);
    };
    const std::atomic<bool> stop = false;
    const Camera camera = look_at({0, 1.5f, 5}, {0, 0.9f, 0}, 0.8f, 71, 45);
    const RenderResult result = render(scene_, camera, asked, progress, stop).value();
    EXPECT_EQ(calls, 4 * 4) << "tiles in passes";
    EXPECT_EQ(shown.pixels, result.film.pixels);
}

/// What FilmSums::put put, tile by tile; and back.
std::vector<Bytes> pieces_of(const std::string& text) {
    StateReader in(std::as_bytes(std::span(text)));
    std::vector<Bytes> pieces(in.number());
    for (Bytes& piece : pieces)
        in.take_new_array(piece);
    return pieces;
}

std::string text_of(const std::vector<Bytes>& pieces) {
    StateWriter out;
    out.put_number(pieces.size());
    for (const Bytes& piece : pieces)
        out.put_array(piece);
    return {reinterpret_cast<const char*>(out.kept().data()), out.kept().size()};
}

TEST_F(PassesOfAFilm, DoNotTakeWhatIsNotTheirs) {
    render_passes_of(options(16), nothing);
    const std::string kept = bytes();
    const auto is_refused = [&](RenderOptions asked, const std::string& text) {
        FilmShare share{FilmPart{}};
        share.begin_passes = [&](const PassFilm& film) -> Result<void> {
            StateReader reader(std::as_bytes(std::span(text)));
            if (film.sums->take(film.work, reader)) return {};
            return fail(ExitCode::io_error, "E-TAKE", "", "");
        };
        asked.share = &share;
        const std::atomic<bool> stop = true;
        const Camera camera = look_at({0, 1.5f, 5}, {0, 0.9f, 0}, 0.8f, 71, 45);
        const Result<RenderResult> got = render(scene_, camera, asked, {}, stop);
        return got.error().id == "E-TAKE";
    };
    EXPECT_FALSE(is_refused(options(16), kept));
    EXPECT_TRUE(is_refused(options(15), kept)) << "more samples than are wanted";
    RenderOptions larger = options(16);
    larger.width = 72;
    EXPECT_TRUE(is_refused(larger, kept));
    std::vector<Bytes> pieces = pieces_of(kept);
    EXPECT_FALSE(is_refused(options(16), text_of(pieces)));
    pieces[1].push_back(std::byte{0});
    EXPECT_TRUE(is_refused(options(16), text_of(pieces))) << "a tile has more bytes";
    pieces[1].pop_back();
    std::swap(pieces[0], pieces[1]);
    EXPECT_TRUE(is_refused(options(16), text_of(pieces))) << "tiles in each other's places";
    for (size_t size = 0; size < kept.size(); size += 100'003)
        EXPECT_TRUE(is_refused(options(16), kept.substr(0, size))) << size;
    RenderOptions adaptive = options(64);
    adaptive.adaptive = AdaptiveOptions{.noise_target = 0.03, .min_samples = 8};
    EXPECT_TRUE(is_refused(adaptive, kept)) << "others decided over samples";
    render_passes_of(adaptive, nothing);
    const std::string decided = bytes();
    EXPECT_FALSE(is_refused(adaptive, decided));
    for (size_t size = 0; size < decided.size(); size += 100'003)
        EXPECT_TRUE(is_refused(adaptive, decided.substr(0, size))) << size;
    EXPECT_TRUE(is_refused(options(64), decided));
}

}  // namespace
}  // namespace obscura::test
