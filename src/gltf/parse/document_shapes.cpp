// gltf/parse/document_shapes.cpp - reads OBSCURA_shape and KHR_implicit_shapes.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/document_shapes.h"

#include "gltf/parse/list_text.h"

#include <algorithm>
#include <cmath>

namespace obscura::gltf {

namespace {

constexpr const char* own_name = "OBSCURA_shape";
constexpr const char* khronos_name = "KHR_implicit_shapes";

constexpr double largest_size = 1e15;

/// A length of one member, above 0 (or at least 0).
float read_size(const ValueReader& object, const char* key, double fallback, bool may_be_zero) {
    const double size = object.number(key, fallback);
    const bool good = size > 0 || (may_be_zero && size == 0);
    if (!good || size > largest_size) {
        object.fault(
            key,
            "E-SHAPE-SIZE",
            std::string(may_be_zero ? "a size from 0 to 1e15" : "a size above 0, to 1e15") +
                " metres is wanted, not " + std::to_string(size));
        return 1;
    }
    return static_cast<float>(size);
}

void read_sphere_shape(const ValueReader& object, GltfShape& out) {
    out.record.size[0] = read_size(object, "radius", 0.5, false);
}

void read_box_shape(const ValueReader& object, GltfShape& out) {
    std::array<double, 3> size = {1, 1, 1};
    object.numbers("size", size);
    for (size_t i = 0; i < 3; ++i) {
        if (!(size[i] > 0) || size[i] > largest_size) {
            object.fault("size", "E-SHAPE-SIZE", "three sizes above 0, to 1e15 metres, are wanted");
            return;
        }
        out.record.size[i] = static_cast<float>(0.5 * size[i]);
    }
}

/// Cylinders and capsules: KHR_implicit_shapes, which forbids that both radii are 0.
void read_tube(const ValueReader& object, GltfShape& out) {
    out.record.size[0] = 0.5f * read_size(object, "height", 0.5, false);
    out.record.size[1] = read_size(object, "radiusBottom", 0.25, true);
    out.record.size[2] = read_size(object, "radiusTop", 0.25, true);
    if (out.record.size[1] <= 0 && out.record.size[2] <= 0) {
        object.fault(
            "radiusTop", "E-SHAPE-SIZE", "one of radiusTop and radiusBottom must be above 0");
    }
}

void read_capsule_shape(const ValueReader& object, GltfShape& out) {
    read_tube(object, out);
    const float half = out.record.size[0];
    const float bottom = out.record.size[1];
    const float top = out.record.size[2];
    if (std::abs(top - bottom) < 1.999f * half) return;
    // One sphere holds the other.
    out.record = {};
    out.record.size[0] = std::max(bottom, top);
    out.record.centre[1] = top > bottom ? half : -half;
}

void read_cone_shape(const ValueReader& object, GltfShape& out) {
    out.record.size[0] = 0.5f * read_size(object, "height", 0.5, false);
    out.record.size[1] = read_size(object, "radius", 0.25, false);
    out.record.size[2] = 0;
}

void read_plane_shape(const ValueReader& object, GltfShape& out) {
    const auto half = [&](const char* key) {
        return object.has(key) ? 0.5f * read_size(object, key, 1, false) : unbounded;
    };
    out.record.size[0] = half("sizeX");
    out.record.size[1] = half("sizeZ");
    out.double_sided = object.boolean("doubleSided", false);
}

void read_disk_shape(const ValueReader& object, GltfShape& out) {
    out.record.size[0] = read_size(object, "radius", 0.5, false);
    out.record.size[1] = read_size(object, "innerRadius", 0, true);
    if (out.record.size[1] >= out.record.size[0]) {
        object.fault("innerRadius", "E-SHAPE-SIZE", "innerRadius must be smaller than radius");
    }
}

/// Moves a quadric's origin to the centre of its box.
void recentre_quadric(std::array<double, 10>& k, const Vec3d& m) {
    const auto [a, b, c, d, e, f, g, h, i, j] = k;
    k[6] = g + 2 * a * m.x + d * m.y + e * m.z;
    k[7] = h + 2 * b * m.y + d * m.x + f * m.z;
    k[8] = i + 2 * c * m.z + e * m.x + f * m.y;
    k[9] = j + m.x * (a * m.x + d * m.y + g) + m.y * (b * m.y + f * m.z + h) +
           m.z * (c * m.z + e * m.x + i);
}

void read_quadric_shape(const ValueReader& object, GltfShape& out) {
    std::array<double, 10> k = {};
    std::array<double, 3> low = {-1, -1, -1};
    std::array<double, 3> high = {1, 1, 1};
    for (const char* key : {"coefficients", "min", "max"})
        object.require(key);
    object.numbers("coefficients", k);
    object.numbers("min", low);
    object.numbers("max", high);
    for (size_t i = 0; i < 3; ++i) {
        const double half = 0.5 * (high[i] - low[i]);
        if (!(half > 0) || std::max(std::abs(low[i]), std::abs(high[i])) > largest_size) {
            object.fault("max", "E-SHAPE-SIZE", "max must be above min on every axis, within 1e15");
            return;
        }
        out.record.centre[i] = static_cast<float>(0.5 * (low[i] + high[i]));
        out.record.size[i] = static_cast<float>(half);
    }
    const auto largest = [](auto first, auto last) {
        double most = 0;
        for (; first != last; ++first)
            most = std::max(most, std::abs(*first));
        return most;
    };
    const double scale = largest(k.begin(), k.end());
    if (!(largest(k.begin(), k.begin() + 9) > 0) || !(scale < 1e100)) {
        object.fault("coefficients",
                     "E-SHAPE-QUADRIC",
                     "one of the first nine coefficients must not be 0, and all within 1e100");
        return;
    }
    for (double& number : k)
        number /= scale;
    recentre_quadric(k, {out.record.centre[0], out.record.centre[1], out.record.centre[2]});
    for (size_t i = 0; i < 10; ++i)
        out.record.k[i] = static_cast<float>(k[i]);
    const std::string projection = object.text("projection", "around");
    if (projection == "above") {
        out.record.kind = static_cast<int32_t>(ShapeKind::quadric_from_above);
    } else if (projection != "around") {
        object.fault("projection", "E-SHAPE-PROJECTION", "accepted are around and above");
    }
}

void read_spheres_shape(DocumentReading& reading, const ValueReader& object, GltfShape& out) {
    const size_t accessors = reading.document.accessors.size();
    object.require("positions");
    out.positions = object.index("positions", accessors, "accessor");
    out.radii = object.index("radii", accessors, "accessor");
    out.record.size[0] = read_size(object, "radius", 0.5, false);
    const auto check = [&](const char* key, int accessor, int rows) {
        if (accessor < 0) return;
        const GltfAccessor& a = reading.document.accessors[static_cast<size_t>(accessor)];
        if (a.rows == rows && a.columns == 1 && a.component == ComponentType::float32) return;
        object.fault(
            key,
            "E-SHAPE-ACCESSOR",
            std::string("an accessor of FLOAT ") + (rows == 3 ? "VEC3" : "SCALAR") + " is wanted");
    };
    check("positions", out.positions, 3);
    check("radii", out.radii, 1);
}

struct ShapeType {
    const char* name;
    ShapeKind kind;
    bool khronos;  ///< also in KHR_implicit_shapes
    void (*read)(const ValueReader&, GltfShape&);
};

constexpr ShapeType shape_types[] = {
    {"sphere", ShapeKind::sphere, true, read_sphere_shape},
    {"box", ShapeKind::box, true, read_box_shape},
    {"cylinder", ShapeKind::frustum, true, read_tube},
    {"capsule", ShapeKind::capsule, true, read_capsule_shape},
    {"plane", ShapeKind::plane, true, read_plane_shape},
    {"disk", ShapeKind::disk, false, read_disk_shape},
    {"cone", ShapeKind::frustum, false, read_cone_shape},
    {"quadric", ShapeKind::quadric, false, read_quadric_shape},
    {"spheres", ShapeKind::sphere, false, nullptr},
};

void check_other_members(const ValueReader& shape, const std::string& type) {
    for (const ShapeType& other : shape_types) {
        if (type == other.name || !shape.has(other.name)) continue;
        shape.fault(other.name,
                    "E-SHAPE-TYPE",
                    "a shape of type " + type + " must not have a member \"" + other.name + "\"");
    }
}

GltfShape read_shape(DocumentReading& reading, const ValueReader& shape, bool khronos) {
    GltfShape out;
    shape.require("type");
    out.type = shape.text("type");
    std::vector<std::string> names;
    for (const ShapeType& type : shape_types) {
        if (khronos && !type.khronos) continue;
        names.emplace_back(type.name);
        if (out.type != type.name) continue;
        check_other_members(shape, out.type);
        out.record.kind = static_cast<int32_t>(type.kind);
        out.known = true;
        if (type.read != nullptr) {
            type.read(shape.child(type.name), out);
        } else {
            read_spheres_shape(reading, shape.child(type.name), out);
        }
        return out;
    }
    // Khronos leaves room for types of other extensions: only what a node draws must be known.
    if (!khronos && !shape.failed()) {
        shape.fault("type",
                    "E-SHAPE-TYPE",
                    "\"" + out.type + "\" is no type of shape; accepted are " + list_text(names));
    }
    return out;
}

}  // namespace

void read_shapes(DocumentReading& reading) {
    for (const bool khronos : {false, true}) {
        const char* name = khronos ? khronos_name : own_name;
        if (khronos) reading.document.first_khronos_shape = reading.document.shapes.size();
        if (!reading.root().has_extension(name)) continue;
        reading.root().extension(name).each("shapes", [&](const ValueReader& shape, size_t) {
            reading.document.shapes.push_back(read_shape(reading, shape, khronos));
        });
    }
}

void read_node_shape(const DocumentReading& reading, const ModelElement& node, GltfNode& out) {
    const Document& document = reading.document;
    const size_t own = document.first_khronos_shape;
    const auto khronos_index = [&](const ValueReader& object, const char* key) {
        const int index = object.index(key, document.shapes.size() - own, "implicit shape");
        return index < 0 ? -1 : index + static_cast<int>(own);
    };
    const bool is_own = node.has_extension(own_name);
    if (!is_own && !node.has_extension(khronos_name)) return;
    const ValueReader object = node.extension(is_own ? own_name : khronos_name);
    out.shape_material = object.index("material", document.materials.size(), "material");
    if (!is_own) {
        object.require("shape");
        out.shape = khronos_index(object, "shape");
    } else if (object.has("shape") == object.has("implicitShape")) {
        object.fault("",
                     "E-SHAPE-NODE",
                     "one of \"shape\" (of OBSCURA_shape) and \"implicitShape\" (of "
                     "KHR_implicit_shapes) is wanted");
    } else if (object.has("shape")) {
        out.shape = object.index("shape", own, "shape");
    } else {
        out.shape = khronos_index(object, "implicitShape");
    }
    if (out.shape >= 0 && !document.shapes[static_cast<size_t>(out.shape)].known) {
        object.fault("",
                     "E-SHAPE-TYPE",
                     "the node draws a shape of the unknown type \"" +
                         document.shapes[static_cast<size_t>(out.shape)].type + "\"");
    }
}

}  // namespace obscura::gltf
