// include/obscura/asset.h - a glTF asset that was opened, and what it has to choose from.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "obscura/api.h"
#include "obscura/error.h"
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

OBSCURA_BEGIN_API

/// How a file is read.
struct AssetOptions {
    std::string scene;    ///< name or index of one of several; empty: the file's default
    std::string variant;  ///< of KHR_materials_variants; empty: the file's own materials
    /// Which animations play: a name, an index, "all" or "none". None given: the first one, where a
    /// View has a time.
    std::optional<std::string> animation;
    int threads = 0;       ///< that read it; 0: every core that the process may use
    bool lenient = false;  ///< makes do with faults that would change the image, and warns
    bool ambient_occlusion = false;  ///< materials keep their occlusion textures
    /// Frames a second of the animation that the layer `motion` tells movement between. Each pose
    /// then takes three times as long; none given: only assets that stand still have that layer.
    std::optional<double> fps;
};

struct CameraInfo {
    std::string name;
    bool orthographic = false;
    /// Column vectors, row after row: element 4 r + c. Looks along -Z, +Y is up.
    std::array<double, 16> world_from_camera = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    double fov_deg = 0;  ///< vertical; perspective cameras
};

struct AnimationInfo {
    std::string name;
    double end_s = 0;  ///< when the last keyframe comes
};

struct NodeInfo {
    std::string path;  ///< from its root: "/lamp/shade", as Cryptomatte layers name it
    std::string mesh;  ///< empty: it has none
};

/// What a file holds, in its order.
struct AssetInfo {
    std::string file;  ///< without folder
    std::string generator;
    std::string copyright;
    std::vector<std::string> scenes;
    int scene = 0;  ///< the one that was opened
    std::vector<std::string> variants;
    std::vector<CameraInfo> cameras;  ///< of that scene
    std::vector<AnimationInfo> animations;
    std::vector<std::string> materials;  ///< names, by their numbers in the file
    bool is_empty = true;                ///< nothing to see; the bounds are zero then
    std::array<double, 3> low = {0, 0, 0}, high = {0, 0, 0};  ///< of all that is seen, in metres
    std::size_t triangles = 0;                                ///< with every instance counted
};

/// An opened asset: a handle, cheap to copy; copies are the same asset. It keeps what rendering has
/// built, so that the next image of the same pose starts at once; a View with a time after one
/// without, and Integrator::uv or the layer "uv" after images without, read the file again. Belongs
/// to its Session, which must outlive it; used by one thread at a time.
class OBSCURA_API Asset {
public:
    const AssetInfo& info() const;
    /// The nodes of all scenes, in the file's order; worked out in each call.
    std::vector<NodeInfo> nodes() const;

    /// Sets a property of a node, mesh, material, light or camera for the images that follow,
    /// whatever animations say; nothing is read again, and BVHs of meshes that only move stay.
    /// info() stays as the file has it.
    ///
    /// pointer: of glTF's object model, as KHR_animation_pointer takes them:
    /// "/nodes/3/translation",
    /// "/nodes/3/extensions/KHR_node_visibility/visible" (1 or 0),
    /// "/materials/2/pbrMetallicRoughness/baseColorFactor". value: as many numbers as it has, in
    /// glTF's units; clamped to its range. Errors: E-SET-UNKNOWN, E-SET-VALUE.
    Result<void> set(const std::string& pointer, const std::vector<double>& value);
    /// The materials of a variant; empty: the file's own. Errors: E-VARIANT-UNKNOWN.
    Result<void> set_variant(const std::string& name);
    /// Gives all that a node draws another material of the file for the images that follow,
    /// whatever the variant. Other nodes that draw the same mesh keep theirs.
    ///
    /// node: index in nodes(); material: in AssetInfo::materials. Errors: E-SET-UNKNOWN; the next
    /// render() tells where the mesh lacks what the material needs: E-MESH-TEXCOORD.
    Result<void> assign_material(std::size_t node, std::size_t material);
    /// Undoes what set() and assign_material() did; the next image reads the file again.
    void reset();

    struct Impl;
    explicit Asset(std::shared_ptr<Impl> impl);

private:
    friend class Session;
    std::shared_ptr<Impl> impl_;
};

OBSCURA_END_API
