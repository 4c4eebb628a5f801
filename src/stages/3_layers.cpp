// stages/3_layers.cpp - reads, evaluates and samples the lobes of KHR_materials_* at the hits.
// SPDX-License-Identifier: Apache-2.0
#include "stages/3_layers.h"

#include "math/sampler.h"
#include "surface/surface_albedo.h"

namespace obscura {
inline namespace OBSCURA_ISA {

namespace {

/// Reads the layers of one group of hits.
class LayerReader {
public:
    /// In  layered: lanes whose material has layers; the others read any record
    OBSCURA_INLINE LayerReader(const SceneView& scene,
                               const HitGeometry& g,
                               const TextureFilter& filter,
                               Mask layered)
        : scene_(scene),
          g_(g),
          record_(scene.layers,
                  select(layered, g.material.integer<&Material::layers>(), LanesI(0))),
          filter_(filter),
          layered_(layered) {}

    template <auto member>
    OBSCURA_INLINE Lanes number(int element = 0) const {
        return record_.number<member>(element);
    }
    template <auto member>
    OBSCURA_INLINE LanesI integer() const {
        return record_.integer<member>();
    }
    template <auto member>
    OBSCURA_INLINE Vec3<Lanes> color() const {
        return record_.vector<member>();
    }

    /// Lanes whose slot has a texture, and coordinates for it.
    template <auto slot, Detail detail = Detail::mean>
    OBSCURA_INLINE FoundSlot find() const {
        FoundSlot found = find_slot<slot, detail>(scene_, g_, record_, filter_, {});
        found.used = found.used & layered_;
        return found;
    }
    OBSCURA_INLINE Rgba<Lanes> read(const FoundSlot& found) const {
        return read_slot(scene_, g_, found, filter_);
    }
    /// A slot's texel, 1 where there is none.
    template <auto slot>
    OBSCURA_INLINE Rgba<Lanes> texel() const {
        const Rgba<Lanes> white{splat3(Lanes(1.0f)), Lanes(1.0f)};
        const FoundSlot found = find<slot>();
        if (none(found.used)) return white;
        const Rgba<Lanes> value = read(found);
        return {select(found.used, value.rgb, white.rgb),
                select(found.used, value.alpha, white.alpha)};
    }

private:
    const SceneView& scene_;
    const HitGeometry& g_;
    TableRecord<Lanes, MaterialLayers> record_;
    const TextureFilter& filter_;
    Mask layered_;
};

/// Reflectance and transmission of the dielectric's boundary.
OBSCURA_INLINE void read_dielectric(const LayerReader& layers, LayeredParams<Lanes>& p) {
    const Lanes specular = layers.number<&MaterialLayers::specular>() *
                           layers.texel<&MaterialLayers::specular_texture>().alpha;
    const Vec3<Lanes> color = layers.color<&MaterialLayers::specular_color>() *
                              layers.texel<&MaterialLayers::specular_color_texture>().rgb;
    const Vec3<Lanes> f0 = color * normal_reflectance(p.eta);
    const Lanes one(1.0f);
    p.f0 = Vec3<Lanes>{min(f0.x, one), min(f0.y, one), min(f0.z, one)} * specular;
    p.transmission = layers.number<&MaterialLayers::transmission>() *
                     layers.texel<&MaterialLayers::transmission_texture>().rgb.x;
    const Lanes passes = select(p.solid, one, p.transmission);
    p.f90 = specular * lerp(one, grazing_reflectance(p.eta), passes);
    p.diffuse_transmission = layers.number<&MaterialLayers::diffuse_transmission>() *
                             layers.texel<&MaterialLayers::diffuse_transmission_texture>().alpha;
    p.diffuse_transmission_color =
        layers.color<&MaterialLayers::diffuse_transmission_color>() *
        layers.texel<&MaterialLayers::diffuse_transmission_color_texture>().rgb;
}

OBSCURA_INLINE void read_sheen(const LayerReader& layers, LayeredParams<Lanes>& p) {
    p.sheen_color = layers.color<&MaterialLayers::sheen_color>() *
                    layers.texel<&MaterialLayers::sheen_color_texture>().rgb;
    const Lanes roughness = layers.number<&MaterialLayers::sheen_roughness>() *
                            layers.texel<&MaterialLayers::sheen_roughness_texture>().alpha;
    p.sheen_alpha = max(roughness * roughness, Lanes(min_sheen_alpha));
}

OBSCURA_INLINE void read_coat(const LayerReader& layers,
                              const LayerContext& at,
                              LayeredParams<Lanes>& p) {
    p.coat = layers.number<&MaterialLayers::clearcoat>() *
             layers.texel<&MaterialLayers::clearcoat_texture>().rgb.x;
    p.coat_alpha = Lanes(1.0f);
    p.coat_normal = {Lanes(0.0f), Lanes(0.0f), Lanes(1.0f)};
    if (none(p.coat > Lanes(0.0f))) return;
    const Lanes roughness = layers.number<&MaterialLayers::clearcoat_roughness>() *
                            layers.texel<&MaterialLayers::clearcoat_roughness_texture>().rgb.y;
    p.coat_alpha = max(roughness * roughness, Lanes(min_ggx_alpha));
    Vec3<Lanes> normal = at.smooth_normal;
    const FoundSlot slot = layers.find<&MaterialLayers::clearcoat_normal_texture, Detail::single>();
    if (any(slot.used)) {
        const Lanes scale = layers.number<&MaterialLayers::clearcoat_normal_scale>();
        normal = tilt_normal(at.tangents, slot.used, normal, layers.read(slot).rgb, scale);
    }
    normal = select(dot(normal, at.ng) < Lanes(0.0f), -normal, normal);
    p.coat_normal = to_local(at.frame, bend_towards_viewer(normal, at.ng, at.wo));
}

OBSCURA_INLINE void read_thin_film(const LayerReader& layers, LayeredParams<Lanes>& p) {
    p.thin_film = {layers.number<&MaterialLayers::iridescence>() *
                       layers.texel<&MaterialLayers::iridescence_texture>().rgb.x,
                   layers.number<&MaterialLayers::iridescence_ior>(),
                   Lanes(0.0f)};
    const Lanes min_nm = layers.number<&MaterialLayers::thin_film_thickness_nm>(0);
    const Lanes max_nm = layers.number<&MaterialLayers::thin_film_thickness_nm>(1);
    const Lanes fraction = layers.texel<&MaterialLayers::thin_film_thickness_texture>().rgb.y;
    p.thin_film.thickness_nm = lerp(min_nm, max_nm, fraction);
    p.thin_film.strength = p.thin_film.strength * thin_film_presence(p.thin_film.thickness_nm);
}

/// Stretches the highlight and turns the frame along it. Without tangents the highlight is round.
OBSCURA_INLINE void read_anisotropy(const LayerReader& layers,
                                    LayerContext& at,
                                    LayeredParams<Lanes>& p) {
    Lanes strength = layers.number<&MaterialLayers::anisotropy>();
    // Round highlights keep their frames beside stretched ones: the same bits in any tile.
    const Mask stretched = at.tangents.known & (strength > Lanes(0.0f));
    if (none(stretched)) return;
    Vec2<Lanes> along{Lanes(1.0f), Lanes(0.0f)};
    const FoundSlot slot = layers.find<&MaterialLayers::anisotropy_texture>();
    if (any(slot.used)) {
        const Vec3<Lanes> texel = layers.read(slot).rgb;
        along.x = select(slot.used, texel.x * Lanes(2.0f) - Lanes(1.0f), along.x);
        along.y = select(slot.used, texel.y * Lanes(2.0f) - Lanes(1.0f), along.y);
        strength = select(slot.used, strength * texel.z, strength);
    }
    const Lanes c = layers.number<&MaterialLayers::anisotropy_cosine>();
    const Lanes s = layers.number<&MaterialLayers::anisotropy_sine>();
    const Vec3<Lanes> direction = at.tangents.tangent * (along.x * c - along.y * s) +
                                  at.tangents.bitangent * (along.x * s + along.y * c);
    const Vec3<Lanes>& n = at.frame.normal;
    const Vec3<Lanes> flat = direction - n * dot(direction, n);
    const Mask turned = stretched & (dot(flat, flat) > Lanes(1e-12f));
    const Vec3<Lanes> tangent = normalize(select(turned, flat, at.frame.tangent));
    at.frame.tangent = select(turned, tangent, at.frame.tangent);
    at.frame.bitangent = select(turned, cross(n, tangent), at.frame.bitangent);
    p.alpha.x = select(turned, lerp(p.alpha.x, Lanes(1.0f), strength * strength), p.alpha.x);
}

/// A path's single wavelength, and the colour that multiplies its throughput.
struct Wavelength {
    Lanes nm;
    Vec3<Lanes> color;  ///< of mean 1 over all paths
};

constexpr float shortest_nm = 430, longest_nm = 650;

/// Wavelengths are uniform between the shortest and the longest, stratified over a pixel's samples.
/// Each adds to one or two neighbouring channels, which peak at the dominant wavelengths of the
/// Rec.709 primaries.
OBSCURA_INLINE Wavelength wavelength_of(const PathLanes& path) {
    const Lanes fraction = unit_float<Lanes>(sobol_pair(path.key, path.sample, wavelength_pair).x);
    const Lanes nm = Lanes(shortest_nm) + fraction * Lanes(longest_nm - shortest_nm);
    const Lanes green_over_blue =
        clamp((nm - Lanes(464.0f)) * Lanes(1.0f / 85.0f), Lanes(0.0f), Lanes(1.0f));
    const Lanes red_over_green =
        clamp((nm - Lanes(549.0f)) * Lanes(1.0f / 62.0f), Lanes(0.0f), Lanes(1.0f));
    return {nm,
            {red_over_green * Lanes(220.0f / 70.0f),
             (green_over_blue - red_over_green) * Lanes(220.0f / 73.5f),
             (Lanes(1.0f) - green_over_blue) * Lanes(220.0f / 76.5f)}};
}

/// How much denser a dispersive medium is for a wavelength than for the Fraunhofer d line.
/// Source  KHR_materials_dispersion: Cauchy's formula through the Abbe number 20 / dispersion
OBSCURA_INLINE Lanes relative_ior(Lanes ior, Lanes dispersion, Lanes nm) {
    const Lanes bend = (ior - Lanes(1.0f)) * dispersion * Lanes(1.0f / 20.0f);
    const Lanes n = ior + bend * (Lanes(523655.0f) / (nm * nm) - Lanes(1.5168f));
    return max(n, Lanes(1.0f)) / ior;
}

/// Sets the index of refraction for the path's wavelength where the medium is dispersive. The
/// reflectance stays that of the d line.
///
/// In   out.params.eta: of the d line
OBSCURA_INLINE void disperse(const LayerReader& layers,
                             const PathLanes& path,
                             Mask entering,
                             LayeredPoint& out) {
    LayeredParams<Lanes>& p = out.params;
    const Lanes dispersion = layers.number<&MaterialLayers::dispersion>();
    const Mask disperses = out.layered & p.solid & (dispersion > Lanes(0.0f));
    if (none(disperses)) return;
    const Wavelength wavelength = wavelength_of(path);
    const Lanes denser =
        relative_ior(layers.number<&MaterialLayers::ior>(), dispersion, wavelength.nm);
    // From the denser side, total reflection depends on the wavelength. The longest wavelength has
    // the lowest index.
    const Lanes thinnest =
        relative_ior(layers.number<&MaterialLayers::ior>(), dispersion, longest_nm);
    out.reflects_white = entering & (p.eta * thinnest > Lanes(1.0f));
    p.eta = select(disperses, p.eta * select(entering, denser, Lanes(1.0f) / denser), p.eta);
    out.wavelength = select(disperses, LanesU(one_wavelength), LanesU(0U));
    const Mask first = disperses & ((path.medium_stack & LanesU(one_wavelength)) == LanesU(0U));
    out.tint = select(first, wavelength.color, out.tint);
}

/// With the weights or without: apart, they would have to load all the parameters again.
template <bool weighs>
void read_point(const LayerReader& layers,
                const LayerHit& hit,
                const BsdfParams<Lanes>& base,
                LayerContext& context,
                LayeredPoint& out) {
    const SceneView& scene = hit.scene;
    const PathLanes& path = hit.path;
    out.layered = context.layered;
    const LanesI medium = select(out.layered, layers.integer<&MaterialLayers::medium>(), LanesI(0));
    out.boundary = boundary_at(scene, path.medium_stack, medium, context.front);
    if (hit.shared != nullptr) {
        SharedLanes shared = read_shared_faces(hit.shared, path.slot);
        shared.exist = shared.exist & (medium > LanesI(0));
        if (any(shared.exist)) join_boundaries(scene, path.medium_stack, shared, out.boundary);
    }
    LayeredParams<Lanes>& p = out.params;
    p.solid = (medium > LanesI(0)) & (!out.boundary.matched);
    out.tint = splat3(Lanes(1.0f));
    out.wavelength = LanesU(0U);
    out.reflects_white = Mask(false);
    p.base_color = base.base_color;
    p.metallic = base.metallic;
    p.alpha = {base.alpha, base.alpha};
    p.eta = select(medium > LanesI(0), out.boundary.eta, layers.number<&MaterialLayers::ior>());
    read_dielectric(layers, p);
    disperse(layers, path, context.front, out);
    read_sheen(layers, p);
    read_anisotropy(layers, context, p);
    read_coat(layers, context, p);
    read_thin_film(layers, p);
    // Coat, sheen and thin film lie on the outside only.
    const Mask inside = (medium > LanesI(0)) & (!context.front);
    p.coat = select(inside, Lanes(0.0f), p.coat);
    p.sheen_color = select(inside, splat3(Lanes(0.0f)), p.sheen_color);
    p.thin_film.strength = select(inside, Lanes(0.0f), p.thin_film.strength);
    const Lanes blurred = invisible_width(p.eta);
    p.alpha.x = select(p.solid, max(p.alpha.x, blurred), p.alpha.x);
    p.alpha.y = select(p.solid, max(p.alpha.y, blurred), p.alpha.y);
    if constexpr (weighs) out.weights = layered_weights(p, to_local(context.frame, context.wo));
    out.lets_through =
        out.layered & ((p.transmission > Lanes(0.0f)) | (p.diffuse_transmission > Lanes(0.0f)));
}

}  // namespace

void read_layered_point(const LayerHit& hit,
                        const BsdfParams<Lanes>& base,
                        LayerContext& context,
                        LayeredPoint& out) {
    const LayerReader reader(hit.scene, hit.geometry, hit.filter, context.layered);
    read_point<true>(reader, hit, base, context, out);
}

void read_layers(const LayerHit& hit,
                 const BsdfParams<Lanes>& base,
                 LayerContext& context,
                 LayeredPoint& out) {
    const LayerReader reader(hit.scene, hit.geometry, hit.filter, context.layered);
    read_point<false>(reader, hit, base, context, out);
}

StraightLight<Lanes> take_straight(LayeredPoint& point, const Vec3<Lanes>& wo) {
    const StraightLight<Lanes> light = take_straight_light(point.params, wo, point.weights);
    return {select(point.layered, light.transmittance, splat3(Lanes(0.0f))),
            select(point.layered, light.probability, Lanes(0.0f))};
}

BsdfValue<Lanes> evaluate_layers(const LayeredPoint& point,
                                 const Vec3<Lanes>& wo,
                                 const Vec3<Lanes>& wi) {
    return evaluate_layered(point.params, point.weights, wo, wi);
}

BsdfSample<Lanes> sample_layers(const LayeredPoint& point,
                                const Vec3<Lanes>& wo,
                                const Vec3<Lanes>& u) {
    return sample_layered(point.params, point.weights, wo, u);
}

}  // namespace OBSCURA_ISA
}  // namespace obscura
