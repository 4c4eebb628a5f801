// crosscheck/twins.cpp - compares analytic shapes with fine meshes of the same form.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/twins.h"

#include "accel/accel.h"
#include "crosscheck/kernel_plan.h"

#include <algorithm>

namespace obscura::crosscheck {

namespace {

bool is_same(const ShapeRecord& a, const ShapeRecord& b) {
    return std::equal(std::begin(a.size), std::end(a.size), std::begin(b.size)) &&
           std::equal(std::begin(a.centre), std::end(a.centre), std::begin(b.centre)) &&
           std::equal(std::begin(a.k), std::end(a.k), std::begin(b.k)) && a.kind == b.kind;
}

/// The records of all analytic shapes, equal ones once. Particles count as spheres.
std::vector<ShapeRecord> distinct_shapes(const Scene& scene) {
    std::vector<ShapeRecord> out;
    for (const Primitive& primitive : scene.primitives) {
        if (primitive.geometry != static_cast<int32_t>(GeometryKind::shapes)) continue;
        for (int32_t i = 0; i < primitive.triangle_count; ++i) {
            const int32_t number = primitive.first_triangle + i;
            const ShapeRecord& record = scene.shapes[static_cast<size_t>(number)];
            const auto same = [&](const ShapeRecord& other) { return is_same(record, other); };
            if (std::none_of(out.begin(), out.end(), same)) out.push_back(record);
        }
    }
    return out;
}

/// One primitive in the world, with a double-sided material.
Scene scene_around(const Primitive& primitive, const Bounds& bounds) {
    Scene scene;
    Material material;
    material.flags = material_double_sided;
    scene.materials.push_back(material);
    scene.material_names.emplace_back();
    scene.material_numbers.push_back(-1);
    scene.primitives.push_back(primitive);
    scene.world_primitive_count = 1;
    scene.bounds = bounds;
    return scene;
}

Scene scene_of_shape(const ShapeRecord& record) {
    Primitive primitive;
    primitive.geometry = static_cast<int32_t>(GeometryKind::shapes);
    primitive.triangle_count = 1;
    const ShapeBox box = shape_bounds(record);
    Scene scene = scene_around(primitive, {box.low, box.high});
    scene.shapes.push_back(record);
    pad_tables(scene);
    return scene;
}

Scene scene_of_mesh(const ShapeMesh& mesh, const Bounds& bounds) {
    Primitive primitive;
    primitive.triangle_count = static_cast<int32_t>(mesh.triangles.size());
    Scene scene = scene_around(primitive, bounds);
    for (const std::array<Vec3d, 3>& triangle : mesh.triangles) {
        for (const Vec3d& p : triangle) {
            scene.indices.push_back(static_cast<uint32_t>(scene.positions.size() / 3));
            for (const double x : {p.x, p.y, p.z})
                scene.positions.push_back(static_cast<float>(x));
        }
    }
    pad_tables(scene);
    return scene;
}

/// The nearest hits of a scene with one shape.
Kernel shape_kernel(const Accel& accel) {
    return {"obscura", [&accel](RayBlock& rays, std::vector<Answer>& answers) {
                HitBlock hits;
                const RayColumns columns = rays.columns();
                accel.intersect(columns, hits.columns(columns.count), Coherence::incoherent, {});
                answers.assign(static_cast<size_t>(columns.count), {});
                for (int i = 0; i < columns.count; ++i) {
                    if (hits.item(i).primitive < 0) continue;
                    answers[static_cast<size_t>(i)] = {static_cast<double>(hits.t(i)), {-1, 0, 0}};
                }
            }};
}

/// The nearest hits of its mesh, attributed to the shape. In double: seen from afar the triangles
/// are as small as Embree's rounding, which would leave holes at their corners.
Kernel mesh_kernel(const TrueScene& mesh) {
    return {"tessellated twins", [&mesh](RayBlock& rays, std::vector<Answer>& answers) {
                answers.assign(static_cast<size_t>(rays.count()), {});
                for (int i = 0; i < rays.count(); ++i) {
                    const TrueHit hit = mesh.nearest(rays.true_ray(i));
                    if (hit.found()) answers[static_cast<size_t>(i)] = {hit.t, {-1, 0, 0}};
                }
            }};
}

void add_figures(PairFigures&& one, TwinReport& report) {
    if (!report.figures) {
        report.figures = std::move(one);
        return;
    }
    report.figures->add(one);
}

}  // namespace

Result<PairFigures> compare_with_mesh(const ShapeRecord& record,
                                      const ShapeMesh& mesh,
                                      uint64_t rays,
                                      const std::string& embree_isa) {
    const Scene shape = scene_of_shape(record);
    const Scene twin = scene_of_mesh(mesh, shape.bounds);
    const auto shape_accel = Accel::build(shape, embree_isa);
    if (!shape_accel) return fail(shape_accel.error());
    const TrueScene true_twin(twin);
    const TrueScene truth(shape, mesh.error_m / edge_ulps);
    RaySetOptions options;
    options.rays = rays;
    const RaySet set(truth, options);
    const Kernel of_shape = shape_kernel(*shape_accel);
    const Kernel of_mesh = mesh_kernel(true_twin);
    PairFigures figures;
    for (const RayBatch& batch : batches_of(set)) {
        AnswerList own;
        compare_kernel(truth, batch, of_shape, {}, {.answers = &own});
        PairFigures part = std::move(compare_kernel(truth, batch, of_mesh, {&own}, {})[0]);
        part.add(figures);
        figures = std::move(part);
    }
    figures.standard = Standard::edges;
    return figures;
}

Result<TwinReport> check_twins(const Scene& scene, uint64_t rays, const std::string& embree_isa) {
    const std::vector<ShapeRecord> shapes = distinct_shapes(scene);
    const size_t count = std::min(shapes.size(), max_twins);
    TwinReport report;
    report.skipped = shapes.size() - count;
    for (size_t i = 0; i < count; ++i) {
        const uint64_t each = std::max<uint64_t>(rays / count, 1);
        const ShapeMesh mesh = tessellate(shapes[i]);
        if (mesh.triangles.empty()) {
            ++report.skipped;
            continue;
        }
        Result<PairFigures> one = compare_with_mesh(shapes[i], mesh, each, embree_isa);
        if (!one) return fail(one.error());
        add_figures(std::move(*one), report);
        ++report.shapes;
        report.triangles += mesh.triangles.size();
    }
    return report;
}

}  // namespace obscura::crosscheck
