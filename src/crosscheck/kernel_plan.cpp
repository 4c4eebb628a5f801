// crosscheck/kernel_plan.cpp - lists the kernels that a scene is checked with.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/kernel_plan.h"

#include "scene/split_curves.h"

namespace obscura::crosscheck {

namespace {

/// Ng of hits, where it is asked for.
struct NormalBlock {
    std::array<std::vector<float>, 3> number;
    bool is_filled = false;

    NormalColumns columns(int count) {
        is_filled = true;
        for (auto& column : number)
            column.resize(static_cast<size_t>(count));
        return {number[0].data(), number[1].data(), number[2].data()};
    }
    Vec3d at(int i) const {
        const auto index = static_cast<size_t>(i);
        return {number[0][index], number[1][index], number[2][index]};
    }
};

Answer hit_answer(const HitBlock& hits, const NormalBlock& normals, int i) {
    const Item item = hits.item(i);
    if (item.primitive < 0) return {};
    Answer answer{static_cast<double>(hits.t(i)), item};
    answer.place = {static_cast<double>(hits.u(i)), static_cast<double>(hits.v(i)), {}, true};
    if (normals.is_filled) {
        answer.place.ng = normals.at(i);
        answer.place.has_ng = true;
    }
    return answer;
}

using AskHits = std::function<void(const RayColumns&, const HitColumns&, NormalBlock&)>;
using AskOccluded = std::function<void(const RayColumns&, uint8_t*)>;

Kernel hit_kernel(std::string name, AskHits ask) {
    return {std::move(name), [ask = std::move(ask)](RayBlock& rays, std::vector<Answer>& answers) {
                HitBlock hits;
                const RayColumns columns = rays.columns();
                NormalBlock normals;
                ask(columns, hits.columns(columns.count), normals);
                answers.resize(static_cast<size_t>(columns.count));
                for (int i = 0; i < columns.count; ++i)
                    answers[static_cast<size_t>(i)] = hit_answer(hits, normals, i);
            }};
}

Kernel occlusion_kernel(std::string name, AskOccluded ask) {
    return {std::move(name),
            [ask = std::move(ask)](RayBlock& rays, std::vector<Answer>& answers) {
                const RayColumns columns = rays.columns();
                std::vector<uint8_t> occluded(static_cast<size_t>(columns.count) + 16);
                ask(columns, occluded.data());
                answers.assign(static_cast<size_t>(columns.count), {});
                for (size_t i = 0; i < answers.size(); ++i)
                    answers[i].any = occluded[i] != 0;
            },
            true};
}

PlannedKernel planned(const std::string& family, int width, bool occlusion = false) {
    const std::string name = family + " " + std::to_string(width);
    return {occlusion ? name + " occluded" : name, width, occlusion};
}

/// Single rays and packets of 16.
KernelGroup group_of(const std::string& family, const KernelChoice& choice, Standard standard) {
    KernelGroup group;
    group.choice = choice;
    group.kernels = {planned(family, 1), planned(family, 16)};
    group.standard = standard;
    return group;
}

}  // namespace

ShapeCounts count_shapes(const Scene& scene) {
    ShapeCounts out;
    for (const Primitive& primitive : scene.primitives) {
        const auto count = static_cast<size_t>(primitive.triangle_count);
        if (is_mesh(primitive)) {
            out.triangles += count;
            continue;
        }
        out.shapes += count;
        if (primitive.geometry == static_cast<int32_t>(GeometryKind::curves)) continue;
        const bool shape = primitive.geometry == static_cast<int32_t>(GeometryKind::shapes);
        const auto first = static_cast<size_t>(primitive.first_triangle);
        const auto sphere = static_cast<int32_t>(ShapeKind::sphere);
        if (!shape || scene.shapes[first].kind == sphere) out.spheres += count;
    }
    return out;
}

std::vector<KernelGroup> plan_kernels(const Scene& scene) {
    std::vector<KernelGroup> groups;
    KernelGroup robust;
    for (const bool occlusion : {false, true}) {
        for (const int width : {1, 4, 8, 16})
            robust.kernels.push_back(planned("robust", width, occlusion));
    }
    groups.push_back(robust);
    KernelChoice fast;
    fast.robust = false;
    groups.push_back(group_of("fast", fast, Standard::none));
    for (const std::string& isa : embree_isas()) {
        KernelChoice choice;
        choice.isa = isa;
        groups.push_back(group_of(isa, choice, Standard::full));
    }
    const ShapeCounts counts = count_shapes(scene);
    KernelChoice triangles;
    triangles.user_triangles = true;
    if (counts.triangles > 0)
        groups.push_back(group_of("user triangles", triangles, Standard::edges));
    KernelChoice points;
    points.sphere_points = true;
    if (counts.spheres > 0) groups.push_back(group_of("sphere points", points, Standard::edges));
    return groups;
}

Kernel make_kernel(const std::shared_ptr<const ReferenceKernels>& kernels,
                   const PlannedKernel& planned) {
    const int width = planned.width;
    if (planned.occlusion) {
        return occlusion_kernel(planned.name,
                                [kernels, width](const RayColumns& rays, uint8_t* occluded) {
                                    kernels->occluded(rays, occluded, width);
                                });
    }
    return hit_kernel(
        planned.name,
        [kernels, width](const RayColumns& rays, const HitColumns& hits, NormalBlock& normals) {
            const NormalColumns columns = normals.columns(rays.count);
            kernels->intersect(rays, hits, width, &columns);
        });
}

std::vector<Kernel> production_kernels(const std::shared_ptr<const Accel>& accel) {
    return {hit_kernel("obscura",
                       [accel](const RayColumns& rays, const HitColumns& hits, NormalBlock&) {
                           accel->intersect(rays, hits, Coherence::incoherent, {});
                       }),
            hit_kernel("obscura coherent",
                       [accel](const RayColumns& rays, const HitColumns& hits, NormalBlock&) {
                           accel->intersect(rays, hits, Coherence::coherent, {});
                       }),
            occlusion_kernel("obscura occluded", [accel](const RayColumns& rays, uint8_t* out) {
                accel->occluded(rays, out, Coherence::incoherent);
            })};
}

Scene opaque_copy(const Scene& scene) {
    Scene out = scene;
    split_long_curves(out);  // as PreparedScene does
    for (Material& material : out.materials) {
        material.flags &= ~(material_alpha_mask | material_alpha_blend);
        material.flags |= material_double_sided;
    }
    return out;
}

}  // namespace obscura::crosscheck
