// tests/truth/shared_faces_test.cpp - solids with coincident faces, as exporters write them.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/shape_scenes.h"
#include "truth/dielectric_scene.h"
#include <cstring>

namespace obscura::test {
namespace shared_faces_truth {

/// One plane layer of a stack, at normal incidence.
struct Layer {
    double ior, sigma, thickness;
};

/// Reflection and transmission of a stack of layers, from its front and from behind.
struct Part {
    double reflects, reflects_behind, passes;
};

Part on_top(const Part& a, const Part& b) {
    const double between = 1 / (1 - a.reflects_behind * b.reflects);
    return {a.reflects + square(a.passes) * b.reflects * between,
            b.reflects_behind + square(b.passes) * a.reflects_behind * between,
            a.passes * b.passes * between};
}

/// The radiance of a stack in air with a white sky on both sides: boundaries and fillings are added
/// one after the other. Source  van de Hulst, "Multiple Light Scattering", 1980, ch. 4 (adding)
double stack(const std::vector<Layer>& layers) {
    Part all{0, 0, 1};
    double before = 1;
    const auto boundary = [&](double ior) {
        const double r = square((ior - before) / (ior + before));
        all = on_top(all, {r, r, 1 - r});
        before = ior;
    };
    for (const Layer& layer : layers) {
        boundary(layer.ior);
        all = on_top(all, {0, 0, std::exp(-layer.sigma * layer.thickness)});
    }
    boundary(1);
    return all.reflects + all.passes;
}

constexpr float glass_ior = 1.5f;
constexpr float liquid_ior = 1.33f;
constexpr Vec3f glass_sigma{0.3f, 0.0f, 1.0f};
constexpr Vec3f liquid_sigma{0.0f, 0.4f, 0.7f};

enum class First { glass, liquid };

/// 1 m of glass and 2 m of liquid in contact. Transmission is equal from both sides, reflection is
/// not.
Vec3d slabs_seen(First nearer) {
    const auto channel = [&](float in_glass, float in_liquid) {
        const Layer glass{double(glass_ior), double(in_glass), 1};
        const Layer liquid{double(liquid_ior), double(in_liquid), 2};
        return nearer == First::glass ? stack({glass, liquid}) : stack({liquid, glass});
    };
    return {channel(glass_sigma.x, liquid_sigma.x),
            channel(glass_sigma.y, liquid_sigma.y),
            channel(glass_sigma.z, liquid_sigma.z)};
}

/// A scene's placement in the world.
struct Placing {
    float size = 1;
    Vec3f turn_axis{0, 1, 0};
    float turn_rad = 0;
    Vec3f move{0, 0, 0};
    bool by_instances = false;

    Vec3f turned(const Vec3f& p) const {
        const Vec3f k = normalize(turn_axis);
        const float c = std::cos(turn_rad);
        return p * c + cross(k, p) * std::sin(turn_rad) + k * (dot(k, p) * (1.0f - c));
    }
    Vec3f operator()(const Vec3f& p) const { return turned(p) * size + move; }
    Affinef affine() const {
        Affinef out;
        const Vec3f columns[4] = {
            turned({1, 0, 0}) * size, turned({0, 1, 0}) * size, turned({0, 0, 1}) * size, move};
        for (int c = 0; c < 4; ++c) {
            out.m[0][c] = columns[c].x;
            out.m[1][c] = columns[c].y;
            out.m[2][c] = columns[c].z;
        }
        return out;
    }
};

/// Makes every primitive an instance of its own.
void make_instances(Scene& scene, const Affinef& place) {
    Instance instance;
    instance.world_from_object = place;
    instance.object_from_world =
        affine_cast<float>(inverse(affine_cast<double>(instance.world_from_object)));
    scene.world_primitive_count = 0;
    for (size_t i = 0; i < scene.primitives.size(); ++i) {
        scene.primitives[i].node = -1;
        instance.mesh = static_cast<int32_t>(i);
        scene.meshes.push_back({static_cast<int32_t>(i), 1});
        scene.instances.push_back(instance);
    }
}

void place(Scene& scene, const Placing& placing) {
    // Absorption is per metre.
    for (MaterialLayers& layers : scene.layers) {
        for (float& a : layers.attenuation)
            a /= placing.size;
    }
    number_media(scene);
    if (placing.by_instances) {
        make_instances(scene, placing.affine());
    } else {
        for (size_t i = 0; i + 6 < scene.positions.size(); i += 3) {
            const Vec3f p =
                placing({scene.positions[i], scene.positions[i + 1], scene.positions[i + 2]});
            scene.positions[i] = p.x;
            scene.positions[i + 1] = p.y;
            scene.positions[i + 2] = p.z;
        }
        for (size_t i = 0; i + 6 < scene.attributes.size(); i += 3) {
            const Vec3f n = placing.turned(
                {scene.attributes[i], scene.attributes[i + 1], scene.attributes[i + 2]});
            scene.attributes[i] = n.x;
            scene.attributes[i + 1] = n.y;
            scene.attributes[i + 2] = n.z;
        }
    }
    const float reach = 20 * placing.size;
    scene.bounds = {placing.move - Vec3f{reach, reach, reach},
                    placing.move + Vec3f{reach, reach, reach}};
}

/// A camera and its settings, before they are placed.
struct Look {
    Vec3f eye{0, 0, 1000};
    float yfov_rad = 1e-5f;
    int samples = 256;
    int tile_size = 16;
};

Film film_of(Scene scene, const Look& look, const Placing& placing = {}) {
    place(scene, placing);
    RenderOptions options;
    options.width = options.height = image_size;
    options.samples_per_pixel = look.samples;
    options.max_bounces = 256;  // of light caught in clear glass; hidden boundaries count, too
    options.tile_size = look.tile_size;
    LightingOptions lighting;
    lighting.environment = constant_environment(1);
    const Camera camera =
        look_at(placing(look.eye), placing({0, 0, 0}), look.yfov_rad, image_size, image_size);
    return render_scene(std::move(scene), lighting, camera, options).film;
}

std::array<Mean, 3> means(Scene scene, const Look& look = {}, const Placing& placing = {}) {
    const Film film = film_of(std::move(scene), look, placing);
    return {film_mean(film, 0), film_mean(film, 1), film_mean(film, 2)};
}

void expect_near(const std::array<Mean, 3>& got, const Vec3d& truth, double tolerance) {
    EXPECT_NEAR(got[0].value, truth.x, tolerance);
    EXPECT_NEAR(got[1].value, truth.y, tolerance);
    EXPECT_NEAR(got[2].value, truth.z, tolerance);
}

/// Images that differ by chance alone: the mean of their pixels' differences is zero.
void expect_alike(const Film& got, const Film& wanted) {
    Film difference = got;
    for (size_t i = 0; i < difference.pixels.size(); ++i)
        difference.pixels[i] -= wanted.pixels[i];
    for (size_t c = 0; c < 3; ++c) {
        const Mean mean = film_mean(difference, c);
        EXPECT_NEAR(mean.value, 0, 4 * mean.error + 0.001) << "channel " << c;
        EXPECT_LT(mean.error, 0.01) << "channel " << c;
    }
}

/// 1 m of glass on 2 m of liquid, whose face lies `gap` behind the glass's.
Scene slabs(First first, float gap = 0) {
    DielectricScene scene;
    const int32_t glass = scene.add(dielectric(glass_ior, glass_sigma));
    const int32_t liquid = scene.add(dielectric(liquid_ior, liquid_sigma));
    const auto add_glass = [&] { scene.box({-9, -9, -1}, {9, 9, 0}, glass); };
    if (first == First::glass) add_glass();
    scene.box({-9, -9, -3}, {9, 9, -1 - gap}, liquid);
    if (first == First::liquid) add_glass();
    return scene.take();
}

TEST(SharedFaces, SlabsFromBothSides) {
    for (const First first : {First::glass, First::liquid}) {
        expect_near(means(slabs(first)), slabs_seen(First::glass), 0.004);
        expect_near(means(slabs(first), {.eye = {0, 0, -1000}}), slabs_seen(First::liquid), 0.004);
    }
}

TEST(SharedFaces, SlabsOfAnySizeAnywhere) {
    for (const float size : {1e-3f, 0.03f, 17.0f, 1e4f}) {
        for (const bool by_instances : {false, true}) {
            const Placing placing{
                size, {0.3f, 1, -0.5f}, 0.8f, Vec3f{3, -1, 2} * size, by_instances};
            SCOPED_TRACE(testing::Message() << size << (by_instances ? ", instances" : ""));
            const Look look{.samples = 128};
            expect_near(means(slabs(First::glass), look, placing), slabs_seen(First::glass), 0.006);
        }
    }
}

/// Gaps that rounding leaves between faces meant to coincide.
TEST(SharedFaces, GapsAndOverlapsOfRoundingAreContact) {
    for (const float gap : {-3e-7f, -1e-7f, 1e-7f, 3e-7f})
        expect_near(means(slabs(First::liquid, gap)), slabs_seen(First::glass), 0.004);
}

TEST(SharedFaces, AnalyticSlabs) {
    DielectricScene builder;
    const int32_t glass = builder.add(dielectric(glass_ior, glass_sigma));
    const int32_t liquid = builder.add(dielectric(liquid_ior, liquid_sigma));
    Scene scene = builder.take();
    ShapeRecord box = make_shape(ShapeKind::box, 9, 9, 0.5f);
    box.centre[2] = -0.5f;
    add_shape(scene, box, glass);
    box.size[2] = 1;
    box.centre[2] = -2;
    add_shape(scene, box, liquid);
    expect_near(means(scene), slabs_seen(First::glass), 0.004);
    expect_near(means(scene, {.eye = {0, 0, -1000}}), slabs_seen(First::liquid), 0.004);
}

/// Two solids of one material in contact are one solid.
TEST(SharedFaces, SolidsOfOneMaterialInContact) {
    DielectricScene scene;
    const int32_t glass = scene.add(dielectric(glass_ior, glass_sigma));
    scene.box({-9, -9, -1}, {9, 9, 0}, glass);
    scene.box({-9, -9, -3}, {9, 9, -1}, glass);
    const auto whole = [](float sigma) { return stack({{1.5, double(sigma), 3}}); };
    expect_near(means(scene.take()),
                {whole(glass_sigma.x), whole(glass_sigma.y), whole(glass_sigma.z)},
                0.004);
}

/// The camera is in the liquid, 500 m behind glass and air.
TEST(SharedFaces, CamerasInsideKnowWhereTheyAre) {
    DielectricScene scene;
    const Vec3f thin{1e-3f, 2e-3f, 4e-3f};
    const int32_t glass = scene.add(dielectric(glass_ior, {}));
    const int32_t liquid = scene.add(dielectric(1.0f, thin));
    scene.box({-9000, -9000, -1000}, {9000, 9000, 500}, glass);
    scene.box({-9000, -9000, 500}, {9000, 9000, 20000}, liquid);
    const double r = square(0.5 / 2.5);
    const auto seen = [&](double sigma) {
        const double way = std::exp(-500 * sigma);
        const double back = way * std::exp(-19000 * sigma) * std::exp(-500 * sigma);
        const double reflected = r + square(1 - r) * r / (1 - r * r);
        const double passed = square(1 - r) / (1 - r * r);
        return way * passed + back * reflected;
    };
    expect_near(means(scene.take()), {seen(1e-3), seen(2e-3), seen(4e-3)}, 0.005);
}

/// A hollow box of glass, full of liquid that reaches `overlap` into the glass.
Scene full_box(float overlap) {
    DielectricScene scene;
    const int32_t glass = scene.add(dielectric(glass_ior, glass_sigma));
    const int32_t liquid = scene.add(dielectric(liquid_ior, liquid_sigma));
    const float in = 0.75f + overlap;
    scene.box({-in, -in, -in}, {in, in, in}, liquid);
    scene.box({-1, -1, -1}, {1, 1, 1}, glass);
    scene.box({0.75f, 0.75f, 0.75f}, {-0.75f, -0.75f, -0.75f}, glass);  // its fronts face inside
    return scene.take();
}

TEST(SharedFaces, FullBoxesFromAllSides) {
    const Look looks[] = {{{2.5f, 2, 4}, 0.45f}, {{-4, 0.3f, 2}, 0.45f}, {{0.5f, -4, -3}, 0.45f}};
    for (const Look& look : looks)
        expect_alike(film_of(full_box(0), look), film_of(full_box(0.02f), look));
}

/// A shell of glass, full of liquid that is `scale` times as large as the room for it.
Scene full_shell(float scale, bool flat) {
    DielectricScene scene;
    const int32_t glass = scene.add(dielectric(glass_ior, glass_sigma));
    const int32_t liquid = scene.add(dielectric(liquid_ior, liquid_sigma));
    scene.builder.sphere({0, 0, 0}, 1, 12, glass, false, flat);
    scene.builder.sphere({0, 0, 0}, 0.75f, 12, glass, true, flat);
    scene.builder.sphere({0, 0, 0}, 0.75f * scale, 12, liquid, false, flat);
    return scene.take();
}

TEST(SharedFaces, FullShells) {
    const Look look{{1, 2, 4}, 0.45f};
    for (const bool flat : {false, true})
        expect_alike(film_of(full_shell(1, flat), look), film_of(full_shell(1.02f, flat), look));
}

TEST(SharedFaces, FullShellsOfAnySizeAnywhere) {
    const Look look{{1, 2, 4}, 0.45f, 64};
    const Film truth = film_of(full_shell(1.02f, true), look);
    for (const float size : {1e-3f, 1e4f}) {
        for (const bool by_instances : {false, true}) {
            SCOPED_TRACE(testing::Message() << size << (by_instances ? ", instances" : ""));
            const Placing placing{size, {1, 1, 0.2f}, 2, Vec3f{1, 2, -3} * size, by_instances};
            expect_alike(film_of(full_shell(1, true), look, placing), truth);
        }
    }
}

/// A ball of liquid where a ball of glass is: the denser one is the dominant medium, and hides the
/// other.
TEST(SharedFaces, OfBallsInTheSamePlaceTheDenserOneIsSeen) {
    const auto balls = [](bool both, bool analytic) {
        DielectricScene builder;
        const int32_t glass = builder.add(dielectric(glass_ior, glass_sigma));
        const int32_t liquid = builder.add(dielectric(liquid_ior, liquid_sigma));
        if (!analytic) {
            if (both) builder.builder.sphere({0, 0, 0}, 1, 12, liquid);
            builder.builder.sphere({0, 0, 0}, 1, 12, glass);
            return builder.take();
        }
        Scene scene = builder.take();
        if (both) add_shape(scene, make_shape(ShapeKind::sphere, 1), liquid);
        add_shape(scene, make_shape(ShapeKind::sphere, 1), glass);
        return scene;
    };
    const Look look{{1, 2, 4}, 0.45f};
    for (const bool analytic : {false, true})
        expect_alike(film_of(balls(true, analytic), look), film_of(balls(false, analytic), look));
}

/// Which face Embree reports first depends on the packet's other rays.
TEST(SharedFaces, BitsDoNotDependOnTiles) {
    const auto bits = [](const Scene& scene, int tile) {
        return film_of(scene, {{1, 2, 4}, 0.45f, 8, tile}).pixels;
    };
    for (const Scene& scene : {full_box(0), full_shell(1, true)}) {
        const auto large = bits(scene, 16);
        const auto small = bits(scene, 4);
        ASSERT_EQ(large.size(), small.size());
        EXPECT_EQ(std::memcmp(large.data(), small.data(), large.size() * sizeof(large[0])), 0);
    }
}

}  // namespace shared_faces_truth
}  // namespace obscura::test
