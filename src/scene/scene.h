// scene/scene.h - a scene as plain arrays joined by indices; what every later room reads.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/unset_array.h"
#include "image/pixels.h"
#include "light/light_profile.h"
#include "light/punctual.h"
#include "math/transform.h"
#include "scene/asset_info.h"
#include "scene/camera_settings.h"
#include "scene/splats.h"
#include "scene/texture_arena.h"
#include "scene/visibility.h"
#include "shape/shape_record.h"
#include "shape/sphere_block.h"
#include "surface/material_layers.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace obscura {

inline constexpr int32_t no_attribute = INT32_MIN;

/// What a primitive consists of: triangles of Scene::indices, records of Scene::shapes, spheres of
/// Scene::spheres or segments of Scene::curve_segments. Shapes compute their own attributes: their
/// bases are 0 for UV set 0 and tangents, and no_attribute for the others. glTF's points (spheres)
/// and lines have no tangents: see is_point_or_line.
enum class GeometryKind : int32_t { triangles, shapes, spheres, curves };

/// A run of triangles (or shapes) with one material. Attribute bases are float offsets such that
/// vertex v (an absolute vertex number, as stored in Scene::indices) starts at base + v *
/// components; a base may be negative, no_attribute means that the attribute is absent. The vertex
/// of a point is its sphere's index in Scene::spheres.
struct Primitive {
    int32_t first_triangle = 0;
    int32_t triangle_count = 0;
    int32_t material = 0;
    int32_t normal_base = no_attribute;   ///< 3 floats a vertex, unit; absent: flat or round
    int32_t tangent_base = no_attribute;  ///< 4 floats a vertex, w = handedness
    int32_t color_base = no_attribute;    ///< 4 floats a vertex, linear, multiplies base colour
    int32_t uv_base[max_uv_sets] = {no_attribute,
                                    no_attribute,
                                    no_attribute,
                                    no_attribute,
                                    no_attribute,
                                    no_attribute,
                                    no_attribute,
                                    no_attribute};
    int32_t node = -1;  ///< glTF node, for primitives in world space; -1 when reached by instances
    int32_t light_base = -1;  ///< first index in the light table when it emits; set by render
    int32_t geometry = 0;     ///< GeometryKind
    int32_t motion_base = no_attribute;  ///< in Motion; no_attribute: the vertices stand still
    int32_t motion_stride = 0;           ///< floats from one time to the next
};

static_assert(sizeof(Primitive) == 19 * 4, "read as 32-bit words: no padding");

inline bool moves(const Primitive& primitive) {
    return primitive.motion_base != no_attribute;
}

inline bool is_mesh(const Primitive& primitive) {
    return primitive.geometry == static_cast<int32_t>(GeometryKind::triangles);
}

/// True for glTF's points and lines, in world space: their thickness is chosen together with the
/// camera (render/points_lines_sizes.h). Told from shapes by the absence of tangents.
inline bool is_point_or_line(const Primitive& primitive) {
    const auto kind = static_cast<GeometryKind>(primitive.geometry);
    return kind == GeometryKind::curves ||
           (kind == GeometryKind::spheres && primitive.tangent_base == no_attribute);
}

/// Identifies geometry across scenes: equal stamps mean equal vertices and triangles. 0: unknown.
using GeometryStamp = uint64_t;

/// A stamp that no geometry has had yet.
GeometryStamp new_geometry_stamp();

/// A run of primitives that share one object space.
struct Mesh {
    int32_t first_primitive = 0;
    int32_t primitive_count = 0;
    GeometryStamp stamp = 0;
};

/// One instance of a mesh in the world.
struct Instance {
    Affinef world_from_object;
    Affinef object_from_world;
    int32_t mesh = 0;
    int32_t node = -1;       ///< glTF node
    int32_t mirrored = 0;    ///< 1 when the determinant is negative: front faces are clockwise
    int32_t light_base = 0;  ///< added to Primitive::light_base for this instance; set by render
    int32_t motion = -1;     ///< first index in Motion::instances; -1: it stands still
};

static_assert(sizeof(Instance) == 29 * 4, "read as 32-bit words: no padding");

inline bool moves(const Instance& instance) {
    return instance.motion >= 0;
}

/// Instance::light_base of instances whose emitters are not in the light table: any light index
/// computed from it stays negative.
inline constexpr int32_t no_light_base = INT32_MIN / 2;

enum class SceneCameraType { perspective, orthographic };

/// A glTF camera placed in the world by a node.
struct SceneCamera {
    std::string name;  ///< the camera's, else the node's name
    SceneCameraType type = SceneCameraType::perspective;
    Affined world_from_camera;
    /// The same at evenly spaced times while the shutter is open; empty: it stands still.
    std::vector<Affined> moving = {};
    double yfov_rad = 0.785398;
    double aspect = 0;  ///< width / height; 0: not given, use the image's
    double xmag_m = 1;
    double ymag_m = 1;
    double znear_m = 0;
    double zfar_m = 0;             ///< 0: infinite
    CameraSettings settings = {};  ///< from OBSCURA_camera
};

/// A participating medium; read as 32-bit words.
struct Medium {
    float extinction[3] = {0, 0, 0};  ///< absorption plus scattering, 1/m, by channel
    float ior = 1;
    float albedo[3] = {0, 0, 0};  ///< scattering / extinction, by channel
    float anisotropy = 0;         ///< mean cosine of a scattering, in (-1, 1)
};

static_assert(sizeof(Medium) == 8 * 4, "no padding");

inline bool scatters(const Medium& medium) {
    return medium.albedo[0] > 0 || medium.albedo[1] > 0 || medium.albedo[2] > 0;
}

/// Motion while the shutter is open, at `steps` times evenly spaced from its opening to its
/// closing, interpolated linearly in between. Scene's own arrays hold the first time.
struct Motion {
    int32_t steps = 1;  ///< 1: nothing moves
    /// 3 floats a vertex of moving primitives: vertex v at time s starts at motion_base + s *
    /// motion_stride + 3 v. Ends with four more floats, as Scene's own.
    std::vector<float> positions;
    std::vector<float> normals;         ///< as positions; zeros where the primitive has none
    std::vector<Affinef> instances;     ///< world_from_object of moving instances, `steps` each
    std::vector<PunctualLight> lights;  ///< `steps` for each of Scene::lights; empty: all stand
};

/// Motion from frame to frame: see scene/frame_motion.h.
struct FrameMotion;

struct Bounds {
    Vec3f low = {INFINITY, INFINITY, INFINITY};
    Vec3f high = {-INFINITY, -INFINITY, -INFINITY};
    bool empty() const { return !(low.x <= high.x); }
};

/// Where a node's mesh is.
struct NodePlace {
    Affined world_from_mesh;  ///< a skinned mesh is in the world already
    /// A skin, weights or instancing give it a shape that other nodes with its mesh have not.
    bool has_own_shape = false;
};

/// Everything that an image needs, except the choice of the camera and an environment from outside
/// the file.
///
/// Primitives [0, world_primitive_count) lie in world space and appear once; the others belong to
/// `meshes` and appear through `instances` only.
struct Scene {
    // These three end with the padding of pad_tables.
    LargeArray<float> positions;  ///< 3 floats a vertex, metres
    /// 3 absolute vertex numbers a triangle, counter-clockwise from the front (before mirroring).
    LargeArray<uint32_t> indices;
    std::vector<ShapeRecord> shapes;
    UnsetArray<float> spheres;  ///< particles, see shape/sphere_block.h; rays read them anywhere
    std::vector<float> curve_points;       ///< x, y, z and radius, in metres
    std::vector<uint32_t> curve_segments;  ///< each goes from this curve point to the next one
    LargeArray<float> attributes;          ///< normals, tangents, UVs and colours; see Primitive
    std::vector<Primitive> primitives;
    int32_t world_primitive_count = 0;
    /// Number of leading world primitives that are the same in every pose; static_stamp identifies
    /// them, as a mesh's stamp does. 0 in a scene that is not one pose of many.
    int32_t static_primitive_count = 0;
    GeometryStamp static_stamp = 0;
    std::vector<Mesh> meshes;
    std::vector<Instance> instances;
    SplatField splats;
    VisibilityFlags visibility;
    Motion motion;
    std::shared_ptr<const FrameMotion> frame_motion;  ///< null: nobody asked for it
    std::vector<Material> materials;     ///< never empty: record 0 is for primitives without one
    std::vector<MaterialLayers> layers;  ///< of the materials that have any; see Material::layers
    std::vector<Medium> media = {Medium{}};  ///< by MaterialLayers::medium; 0 is air
    std::vector<std::string> material_names;
    /// glTF index of each of `materials`, -1: none. A glTF material has several records where some
    /// primitives lack the texture coordinates that it needs.
    std::vector<int32_t> material_numbers;
    TextureArena textures;
    std::vector<PunctualLight> lights;
    std::vector<LightProfile> light_profiles;  ///< by PunctualLight::profile
    /// The file's own environment, latitude-longitude in the world; null: it has none.
    std::shared_ptr<const ImageRgb32f> environment;
    std::vector<SceneCamera> cameras;
    std::vector<NodePlace> node_places;  ///< by glTF node; empty: not asked for
    Bounds bounds;  ///< world space, of all triangles and shapes; an infinite plane counts as 1 m^2
    AssetInfo info;
};

/// Pads the tables that are read four words at a time (Embree's 16 bytes, math/gather4.h): 4 floats
/// after the positions and attributes, 1 number after the indices. Call it once the tables are
/// complete.
void pad_tables(Scene& scene);

}  // namespace obscura
