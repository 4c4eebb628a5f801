// gltf/load.h - a glTF 2.0 file (.gltf or .glb) becomes a scene.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/log.h"
#include "base/memory_budget.h"
#include "gltf/problems.h"
#include "image/rgb_primaries.h"
#include "scene/scene.h"
#include "scene/texel_file.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace obscura::gltf {

/// What --lights does to the lights of the file (KHR_lights_punctual, EXT_lights_ies).
struct LightChoice {
    struct Factor {
        std::string pattern;  ///< of the light's or its node's name, see base/name_search.h
        double factor = 1;    ///< times its intensity; 0: the light is left out

        bool operator==(const Factor&) const = default;
    };
    bool off = false;                  ///< all are left out
    std::vector<Factor> factors = {};  ///< the last one that fits a light counts

    bool operator==(const LightChoice&) const = default;
};

/// What --holdout, --camera-invisible, --no-shadow and --catcher do to parts of the file.
struct VisibilityRule {
    std::string pattern;  ///< of the names of nodes (with all below them), meshes and materials
    uint8_t flag = 0;     ///< of scene/visibility.h

    bool operator==(const VisibilityRule&) const = default;
};

struct LoadOptions {
    int scene = -1;  ///< number of the scene in the file; -1: scene_name, else the file's own
    std::string scene_name;  ///< used when not empty and `scene` is -1
    std::string variant;     ///< of KHR_materials_variants; empty: the primitives' own materials
    /// --animation: "all", "none", a name or an index. Without it the first one is played where a
    /// time is given.
    std::optional<std::string> animation = {};
    std::optional<double> time_s = {};  ///< of load_gltf; nothing: as stored, or 0 with `animation`
    /// Meshes keep TEXCOORD_0 even if no texture reads it: for the AOV `uv`.
    bool keeps_uv = false;
    bool occlusion = false;  ///< --occlusion ambient: materials keep their occlusion textures
    /// Colours of the file, which are Rec.709, become those of another rendering space
    /// (image/rendering_space.h).
    std::optional<Matrix3> from_rec709 = {};
    bool info_only = false;  ///< images are only measured: Scene::textures.texels stays empty
    /// Problems that would change the image become warnings, not errors: see gltf/problems.h.
    bool lenient = false;
    std::optional<TextureLimit> texture_limit = {};  ///< --texture-memory, --texture-cache
    LightChoice lights = {};                         ///< --lights
    /// --hide: patterns of the names of nodes (with all below them), meshes and materials whose
    /// geometry is not loaded. The lights of hidden nodes are left out, their cameras stay.
    std::vector<std::string> hidden = {};
    std::vector<VisibilityRule> visibility = {};
    /// Scenes of an animated asset get Scene::frame_motion, with frames this far apart: for the
    /// layer `motion`.
    std::optional<double> frame_step_s = {};
    bool places_nodes = false;  ///< scenes get Scene::node_places
    /// The file's up is +Z, against glTF: all of it is turned so that its +Z becomes the world's
    /// +Y.
    bool z_up = false;

    bool operator==(const LoadOptions&) const = default;
};

/// Reads, checks and converts one asset with everything that it refers to.
///
/// Material 0 is the default material, for primitives without one; glTF material m is record m + 1
/// (behind them come copies without textures whose UV set a primitive lacks). Materials that the
/// chosen scene does not use keep their factors and lose their textures.
///
/// All problems of meshes and images come together: the first one with the others in Error::also,
/// in the order of gltf/problems.h: accessors, meshes as the scene shows them, images.
///
/// Errors  64 E-SCENE-UNKNOWN, E-VARIANT-UNKNOWN, E-LIGHT-UNKNOWN, E-HIDE-UNKNOWN,
///         E-VISIBILITY-UNKNOWN, E-ANIM-UNKNOWN, E-ANIM-AMBIGUOUS;
///         65 E-GLB-*, E-JSON-*, E-DOC-*, E-ACC-*, E-BUF-*, E-MESH-*, E-NODE-*, E-MESHOPT-*,
///         E-DRACO-*, E-SKIN-*, E-ANIM-*, E-LIGHT-*, E-IES-*, E-ENV-FACES; 66 E-SCENE-MISSING;
///         67 E-RES-MISSING, E-RES-SHORT, E-IMG-*; 69 E-VERSION, E-EXT-REQUIRED,
///         E-MESHOPT-VERSION, E-DRACO-VERSION; 77 E-URI-REFUSED, E-LIMIT-*; 33 E-MEM, E-MEMORY
Result<Scene> load_gltf(const std::filesystem::path& file, const LoadOptions& options, Log& log);

/// While a shutter is open.
struct ShutterTimes {
    double open_s = 0;
    double close_s = 0;
    double time_s = 0;  ///< the image's own, for LoadOptions::frame_step_s

    bool operator==(const ShutterTimes&) const = default;
};

/// An asset that is read once and posed at many times: the file is parsed, and its images are
/// decoded, only once.
class PosedAsset {
public:
    /// Reads and checks the file and everything that it refers to but the images.
    ///
    /// In      options: as for load_gltf, without time_s; has_time: it will be posed at times
    /// Errors  those of load_gltf
    static Result<PosedAsset> open(const std::filesystem::path& file,
                                   const LoadOptions& options,
                                   bool has_time,
                                   Log& log);
    PosedAsset(PosedAsset&&) noexcept;
    PosedAsset& operator=(PosedAsset&&) noexcept;
    ~PosedAsset();

    /// Poses the scene by the chosen animations at a time; equal times give equal scenes.
    ///
    /// In      last: no further scene will be asked for; memory is given back sooner
    /// Errors  those of load_gltf
    Result<Scene> scene_at(double time_s, bool last, Log& log);

    /// The scene with its motion while the shutter is open (scene/motion.h). When something appears
    /// or vanishes meanwhile, a warning says that nothing moves: the scene is that at shutter open.
    ///
    /// Errors  those of load_gltf
    Result<Scene> scene_between(const ShutterTimes& shutter, bool last, Log& log);

    /// Tells which variants scenes will be asked for, "" for the file's own materials: what they
    /// have in common is read once.
    ///
    /// In      several: scenes of one time will follow each other, also where there is one variant
    /// Errors  64 E-VARIANT-UNKNOWN
    Result<void> plan_variants(const std::vector<std::string>& names, bool several);

    /// The variant of the scenes that follow.
    ///
    /// Errors  64 E-VARIANT-UNKNOWN
    Result<void> choose_variant(const std::string& name);

    /// Sets a property to a value in all scenes that follow, whatever animations say: nodes,
    /// materials, lights, cameras.
    ///
    /// In      pointer: as those of KHR_animation_pointer: "/nodes/3/translation"
    /// Errors  64 E-SET-UNKNOWN, E-SET-VALUE
    Result<void> set_value(const std::string& pointer, const std::vector<double>& value);

    /// Gives a node a material in all scenes that follow, whatever the variant.
    ///
    /// In      node, material: their numbers in the file
    /// Errors  64 E-SET-UNKNOWN
    Result<void> assign_material(size_t node, size_t material);

    /// What all its scenes have in common.
    const AssetInfo& info() const;

    /// Those of files_of_asset.
    const std::vector<std::filesystem::path>& files() const;

    /// The nodes whose names fit the pattern, and all below them: 1 by the node's number.
    ///
    /// Errors  64 E-NODE-UNKNOWN
    Result<std::vector<char>> subtree(const std::string& pattern) const;

    /// What the latest scene lacks; nothing unless LoadOptions::lenient.
    const Degraded& degraded() const;

    /// What the texels of its scenes have taken from the memory budget: to be kept as long as they.
    const std::vector<MemoryCharge>& texture_charges() const;

    /// Takes back what the next scene reuses from a scene that is no longer needed: decoded images
    /// and static geometry.
    void take_back(Scene&& scene);

private:
    struct Impl;
    explicit PosedAsset(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace obscura::gltf
