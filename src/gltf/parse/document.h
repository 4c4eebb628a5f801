// gltf/parse/document.h - a glTF file as plain structs: every index checked, nothing converted yet.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/log.h"
#include "gltf/parse/document_animation.h"
#include "gltf/parse/material_factors.h"
#include "gltf/problems.h"
#include "image/rgb_primaries.h"
#include "math/transform.h"
#include "scene/asset_info.h"
#include "scene/camera_settings.h"
#include "shape/shape_record.h"
#include "surface/harmonics.h"
#include "surface/material_layers.h"

#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace obscura::gltf {

enum class ComponentType : uint16_t {
    int8 = 5120,
    uint8 = 5121,
    int16 = 5122,
    uint16 = 5123,
    uint32 = 5125,
    float32 = 5126
};

size_t component_size(ComponentType type);

struct GltfBuffer {
    std::string name;
    std::optional<std::string> uri;
    uint64_t byte_length = 0;
};

enum class MeshoptMode { attributes, triangles, indices };
enum class MeshoptFilter { none, octahedral, quaternion, exponential, color };

/// Where a view's compressed data are and what they hold, by EXT_ and KHR_meshopt_compression.
struct GltfMeshopt {
    int buffer = -1;  ///< -1: the view is not compressed
    uint64_t byte_offset = 0;
    uint64_t byte_length = 0;
    uint64_t byte_stride = 0;  ///< of a decoded element
    uint64_t count = 0;        ///< stride * count is the view's own length
    MeshoptMode mode = MeshoptMode::attributes;
    MeshoptFilter filter = MeshoptFilter::none;
};

struct GltfBufferView {
    int buffer = 0;
    uint64_t byte_offset = 0;
    uint64_t byte_length = 0;
    uint64_t byte_stride = 0;  ///< 0: tightly packed
    GltfMeshopt meshopt;
};

struct GltfSparse {
    uint64_t count = 0;  ///< 0: the accessor is not sparse
    int index_view = 0;
    uint64_t index_offset = 0;
    ComponentType index_type = ComponentType::uint32;
    int value_view = 0;
    uint64_t value_offset = 0;
};

struct GltfAccessor {
    int view = -1;  ///< -1: zeros
    uint64_t byte_offset = 0;
    ComponentType component = ComponentType::float32;
    bool normalized = false;
    uint64_t count = 0;
    int rows = 1;
    int columns = 1;  ///< 2 to 4 for matrices
    GltfSparse sparse;
    bool has_bounds = false;  ///< the first three of min and max
    std::array<double, 3> low = {};
    std::array<double, 3> high = {};
};

/// Upper limit on emission, in nits, candela or lux. Single precision still holds its product with
/// the peak of a mirror's narrowest lobe, or its irradiance at a lamp's shortest distance.
inline constexpr double brightest = 1e20;

struct GltfImage {
    std::string name;
    std::optional<std::string> uri;
    int view = -1;
    std::string mime;
    /// Of a copy that holds roughness: the factor of the glossiness, and the image that was copied.
    double glossiness = 0;
    int glossiness_of = -1;
};

struct GltfSampler {
    int mag_filter = 9729;  ///< LINEAR
    int min_filter = 9987;  ///< LINEAR_MIPMAP_LINEAR
    int wrap_s = 10497;     ///< REPEAT
    int wrap_t = 10497;
};

struct GltfTexture {
    int sampler = -1;
    int image = -1;  ///< KTX2 before WebP before the core one; -1: none that can be read
};

/// Factors are final; the slots' `texture` is still a glTF texture.
struct GltfMaterial {
    std::string name;
    Material values;
    std::optional<MaterialLayers> layers = {};  ///< where it has extensions that need them
};

/// The attributes of KHR_gaussian_splatting.
struct GltfSplatAttributes {
    int rotation = -1;
    int scale = -1;
    int opacity = -1;
    /// SH_DEGREE_l_COEF_n at l^2 + n
    std::array<int, max_harmonics> harmonics = {
        -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1};
};

/// A number for each vertex attribute that is read; -1: it is absent.
struct GltfAttributes {
    int position = -1;
    int normal = -1;
    int tangent = -1;
    int color = -1;
    std::array<int, max_uv_sets> uv = {-1, -1, -1, -1, -1, -1, -1, -1};
    std::vector<int> joints = {};  ///< JOINTS_n, by set
    std::vector<int> weights = {};
    GltfSplatAttributes splats = {};
};

/// KHR_materials_variants: a material that some variants give to a primitive.
struct GltfVariantMaterial {
    int material = -1;
    std::vector<int> variants;  ///< in Document::variants
};

/// The attributes' numbers are those of accessors.
struct GltfPrimitive : GltfAttributes {
    int indices = -1;
    int material = -1;           ///< in the chosen variant
    int own_material = -1;       ///< where no mapping names the variant
    int assigned_material = -1;  ///< by assign_material, in every variant; -1: none
    int mode = 4;
    int own_mode = 4;                ///< while it is not hidden
    bool is_splats = false;          ///< KHR_gaussian_splatting, not compressed
    bool splats_are_linear = false;  ///< their colours have no sRGB curve
    int draco_view = -1;             ///< KHR_draco_mesh_compression; -1: it is not compressed
    GltfAttributes draco_ids;        ///< the attributes' numbers in the compressed data
    std::vector<GltfVariantMaterial> variants;
    std::vector<GltfAttributes> targets;  ///< accessors of differences, by morph target
};

struct GltfMesh {
    std::string name;
    std::vector<GltfPrimitive> primitives;
    size_t target_count = 0;      ///< morph targets, the same for all primitives
    std::vector<double> weights;  ///< of the targets; empty: all are 0
    bool bends = false;           ///< an animation that is played changes the weights
};

/// A shape of OBSCURA_shape or KHR_implicit_shapes.
struct GltfShape {
    std::string type;
    bool known = false;  ///< false: an unknown type, which no node may draw
    ShapeRecord record;  ///< for particles only the common radius, size[0]
    int positions = -1;  ///< accessors of particles
    int radii = -1;      ///< -1: all have the common radius
    bool double_sided = false;
};

/// EXT_mesh_gpu_instancing: accessors of as many transforms; all -1: the mesh stands once.
struct GltfInstancing {
    int translation = -1;
    int rotation = -1;
    int scale = -1;
};

/// EXT_lights_ies of a node.
struct GltfProfileUse {
    int profile = -1;  ///< in Document::profiles; -1: none
    double multiplier = 1;
    std::array<double, 3> color = {1, 1, 1};
};

struct GltfNode {
    std::string name;
    GltfTrs trs;              ///< what parent_from_node is made of, unless has_matrix
    bool has_matrix = false;  ///< such a node has no `trs` and cannot be animated
    Affined parent_from_node;
    std::vector<double> weights;  ///< of its mesh's morph targets; empty: the mesh's own
    int mesh = -1;
    int camera = -1;
    int light = -1;
    GltfProfileUse ies;
    int skin = -1;
    int shape = -1;  ///< in Document::shapes
    int shape_material = -1;
    GltfInstancing instancing;
    bool visible = true;  ///< KHR_node_visibility, of this node alone
    bool moves = false;   ///< an animation that is played changes its transform or `visible`
    bool bends = false;   ///< one changes the weights of this node
    std::vector<int> lower_levels;  ///< MSFT_lod: nodes that stand for this one far away
    std::vector<int> children;
};

struct GltfScene {
    std::string name;
    std::vector<int> nodes;
    int environment = -1;  ///< in Document::environments
};

struct GltfCamera {
    std::string name;
    bool orthographic = false;
    double yfov_rad = 0;
    double aspect = 0;
    double xmag_m = 0;
    double ymag_m = 0;
    double znear_m = 0;
    double zfar_m = 0;
    CameraSettings settings = {};  ///< OBSCURA_camera
};

enum class GltfLightType { point, spot, directional };

struct GltfLight {
    std::string name;
    GltfLightType type = GltfLightType::point;
    std::array<double, 3> color = {1, 1, 1};
    double intensity = 1;
    double range = 0;
    double inner_cone_rad = 0;  ///< as in the file, whatever the outer one is
    double outer_cone_rad = 0.785398163397448;
};

/// EXT_lights_ies: where a photometric file is.
struct GltfLightProfile {
    std::string name;
    std::optional<std::string> uri;
    int view = -1;
};

/// EXT_lights_image_based, as far as a path tracer needs it.
struct GltfEnvironment {
    std::string name;
    double intensity = 1;
    std::array<double, 4> rotation = {0, 0, 0, 1};  ///< unit
    std::array<int, 6> images = {};                 ///< of mip level 0: +X, -X, +Y, -Y, +Z, -Z
    uint64_t side = 0;                              ///< as the file declares it
};

struct Document {
    std::string file;  ///< as the user named it, for messages
    std::string version;
    std::string generator;
    std::string copyright;
    std::vector<GltfBuffer> buffers;
    std::vector<GltfBufferView> views;
    std::vector<GltfAccessor> accessors;
    std::vector<GltfImage> images;
    std::vector<GltfSampler> samplers;
    std::vector<GltfTexture> textures;
    std::vector<GltfMaterial> materials;
    std::vector<MaterialFactors> material_factors;  ///< of each
    std::vector<GltfMesh> meshes;
    std::vector<GltfNode> nodes;
    std::vector<GltfScene> scenes;
    int scene = -1;  ///< the file's own choice
    std::vector<GltfCamera> cameras;
    std::vector<GltfLight> lights;
    std::vector<GltfLightProfile> profiles;
    std::vector<GltfEnvironment> environments;
    std::vector<GltfShape> shapes;  ///< of OBSCURA_shape, then those of KHR_implicit_shapes
    size_t first_khronos_shape = 0;
    std::vector<GltfSkin> skins;
    std::vector<GltfAnimation> animations;
    std::vector<std::string> variants;  ///< KHR_materials_variants: names
    /// 1 for materials of variants that will be shown, too: their images are kept with the others.
    std::vector<char> planned_materials;
    std::string xmp;  ///< the asset's XMP packet as JSON text
    std::vector<ExtensionInfo> extensions;
    std::vector<ReportEntry> report;
    bool keeps_uv = false;                    ///< LoadOptions::keeps_uv
    bool reads_occlusion = false;             ///< LoadOptions::occlusion
    std::optional<Matrix3> from_rec709 = {};  ///< LoadOptions::from_rec709
    Affined world_from_root = {};             ///< above all nodes without a parent

    /// "scene.glb#/accessors/12", for messages.
    std::string at(std::string_view pointer) const { return file + "#" + std::string(pointer); }
    std::string at(std::string_view array, size_t index) const {
        return file + "#/" + std::string(array) + "/" + std::to_string(index);
    }
};

/// How materials are read.
struct MaterialReading {
    bool occlusion = false;                   ///< LoadOptions::occlusion
    std::optional<Matrix3> from_rec709 = {};  ///< LoadOptions::from_rec709
};

/// Reads and checks a whole asset: types, ranges, indices, version, required extensions, the node
/// graph. Says once what is ignored. Accessors without elements go to `problems` (E-ACC-COUNT).
///
/// The tree is checked and repaired (gltf/parse/preflight.h), tinygltf makes its model from it
/// (gltf/parse/model.h), and the document is made from the model.
///
/// Errors  65 E-JSON-TYPE, E-DOC-*, E-NODE-*; 69 E-VERSION, and E-EXT-REQUIRED unless lenient
Result<Document> read_document(nlohmann::json tree,
                               const std::string& file,
                               Problems& problems,
                               Log& log,
                               const MaterialReading& materials = {});

}  // namespace obscura::gltf
