// accel/make_geometry.cpp - makes the Embree geometry of a primitive.
// SPDX-License-Identifier: Apache-2.0
#include "accel/accel_impl.h"
#include "accel/moving_geometry.h"
#include "accel/reference_geometry.h"
#include "base/parallel.h"

#include <algorithm>

namespace obscura {

namespace {

void set_filters(Accel::Impl& impl, int32_t primitive_index, RTCGeometry geometry) {
    const auto index = static_cast<size_t>(primitive_index);
    const FilterKinds kinds = filters_of(impl, primitive_index);
    if (kinds.visibility) {
        rtcSetGeometryUserData(geometry, &impl.alpha[index]);
        rtcSetGeometryIntersectFilterFunction(geometry, visibility_filter);
        rtcSetGeometryOccludedFilterFunction(geometry, visibility_shadow_filter);
        return;
    }
    if (kinds.alpha) {
        rtcSetGeometryUserData(geometry, &impl.alpha[index]);
        rtcSetGeometryIntersectFilterFunction(geometry, alpha_filter);
        rtcSetGeometryOccludedFilterFunction(geometry, alpha_filter);
    }
    if (kinds.thin_wall) {
        rtcSetGeometryOccludedFilterFunction(
            geometry, kinds.alpha ? alpha_thin_wall_filter : thin_wall_filter);
    }
}

void set_static_triangles(const Scene& scene, const Primitive& primitive, RTCGeometry geometry) {
    rtcSetSharedGeometryBuffer(geometry,
                               RTC_BUFFER_TYPE_VERTEX,
                               0,
                               RTC_FORMAT_FLOAT3,
                               scene.positions.data(),
                               0,
                               3 * sizeof(float),
                               (scene.positions.size() - 4) / 3);
    rtcSetSharedGeometryBuffer(geometry,
                               RTC_BUFFER_TYPE_INDEX,
                               0,
                               RTC_FORMAT_UINT3,
                               scene.indices.data(),
                               static_cast<size_t>(primitive.first_triangle) * 3 * sizeof(uint32_t),
                               3 * sizeof(uint32_t),
                               static_cast<size_t>(primitive.triangle_count));
}

/// Sets filters and quality of Embree's built-in geometry, and commits it.
RTCGeometry commit(Accel::Impl& impl, int32_t primitive_index, RTCGeometry geometry) {
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
    rtcSetGeometryMask(geometry, 0xFFFFFFFFU);
    set_filters(impl, primitive_index, geometry);
    rtcCommitGeometry(geometry);
    return geometry;
}

RTCGeometry make_triangles(Accel::Impl& impl, int32_t primitive_index) {
    const Scene& scene = *impl.scene;
    const Primitive& primitive = scene.primitives[static_cast<size_t>(primitive_index)];
    RTCGeometry geometry = rtcNewGeometry(impl.device, RTC_GEOMETRY_TYPE_TRIANGLE);
    if (moves(primitive)) {
        set_moving_triangles(scene, primitive, geometry);
    } else {
        set_static_triangles(scene, primitive, geometry);
    }
    return commit(impl, primitive_index, geometry);
}

/// Lines as Embree's own capsules; it joins segments whose indices follow each other.
RTCGeometry make_curves(Accel::Impl& impl, int32_t primitive_index) {
    const Scene& scene = *impl.scene;
    const Primitive& primitive = scene.primitives[static_cast<size_t>(primitive_index)];
    RTCGeometry geometry = rtcNewGeometry(impl.device, RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE);
    rtcSetSharedGeometryBuffer(geometry,
                               RTC_BUFFER_TYPE_VERTEX,
                               0,
                               RTC_FORMAT_FLOAT4,
                               scene.curve_points.data(),
                               0,
                               4 * sizeof(float),
                               scene.curve_points.size() / 4);
    rtcSetSharedGeometryBuffer(geometry,
                               RTC_BUFFER_TYPE_INDEX,
                               0,
                               RTC_FORMAT_UINT,
                               scene.curve_segments.data(),
                               static_cast<size_t>(primitive.first_triangle) * sizeof(uint32_t),
                               sizeof(uint32_t),
                               static_cast<size_t>(primitive.triangle_count));
    return commit(impl, primitive_index, geometry);
}

/// False for an infinite plane: no box can hold it, so it is no Embree geometry.
bool fill_shape_geometry(Accel::Impl& impl, int32_t primitive_index) {
    const Scene& scene = *impl.scene;
    const Primitive& primitive = scene.primitives[static_cast<size_t>(primitive_index)];
    const Material& material = scene.materials[static_cast<size_t>(primitive.material)];
    ShapeGeometry& out = impl.shapes[static_cast<size_t>(primitive_index)];
    const auto first = static_cast<size_t>(primitive.first_triangle);
    const bool spheres = primitive.geometry == static_cast<int32_t>(GeometryKind::spheres);
    out.records = spheres ? nullptr : &scene.shapes[first];
    out.spheres = spheres ? &scene.spheres[first * 4] : nullptr;
    out.count = primitive.triangle_count;
    out.single_sided = (material.flags & material_double_sided) == 0;
    const FilterKinds kinds = filters_of(impl, primitive_index);
    if (kinds.visibility) out.visibility = &impl.alpha[static_cast<size_t>(primitive_index)];
    if (kinds.alpha) out.alpha = &impl.alpha[static_cast<size_t>(primitive_index)];
    out.thin_wall = kinds.thin_wall;
    return spheres || !is_unbounded(scene.shapes[first]);
}

/// Boxes around the blocks of a primitive of spheres. Returns the number of its clusters.
size_t fill_boxes(const ShapeGeometry& spheres, UnsetArray<float>& boxes) {
    const size_t blocks = (static_cast<size_t>(spheres.count) + sphere_block - 1) / sphere_block;
    const size_t clusters = (blocks + cluster_blocks - 1) / cluster_blocks;
    boxes.resize(clusters * cluster_floats);
    parallel_for(clusters, [&](size_t cluster) {
        const size_t first = cluster * cluster_blocks;
        fill_cluster_boxes(spheres.spheres + first * sphere_block_floats,
                           static_cast<int>(std::min<size_t>(blocks - first, cluster_blocks)),
                           &boxes[cluster * cluster_floats]);
    });
    return clusters;
}

RTCGeometry make_shapes(Accel::Impl& impl, int32_t primitive_index) {
    const auto primitive = static_cast<size_t>(primitive_index);
    ShapeGeometry& shapes = impl.shapes[primitive];
    auto count = static_cast<size_t>(shapes.count);
    if (shapes.records == nullptr) {
        count = fill_boxes(shapes, impl.block_boxes[primitive]);
        shapes.boxes = impl.block_boxes[primitive].data();
    }
    RTCGeometry geometry = rtcNewGeometry(impl.device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(count));
    rtcSetGeometryUserData(geometry, &shapes);
    rtcSetGeometryBoundsFunction(geometry, impl.functions.shapes->bounds, nullptr);
    rtcSetGeometryIntersectFunction(
        geometry,
        impl.kernels.counts_tests ? intersect_counted_shape : impl.functions.shapes->intersect);
    rtcSetGeometryOccludedFunction(geometry, impl.functions.shapes->occluded);
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
    rtcSetGeometryMask(geometry, 0xFFFFFFFFU);
    rtcCommitGeometry(geometry);
    return geometry;
}

}  // namespace

FilterKinds filters_of(const Accel::Impl& impl, int32_t index) {
    if (impl.alpha.empty()) return {};
    const Primitive& primitive = impl.scene->primitives[static_cast<size_t>(index)];
    return {needs_alpha_filter(*impl.scene, primitive, impl.materials_with_holes),
            impl.thin_walls[static_cast<size_t>(primitive.material)] != 0,
            !impl.visibility_filters.empty() &&
                impl.visibility_filters[static_cast<size_t>(index)] != 0};
}

RTCGeometry make_geometry(Accel::Impl& impl, int32_t index) {
    const int32_t kind = impl.scene->primitives[static_cast<size_t>(index)].geometry;
    if (kind == static_cast<int32_t>(GeometryKind::curves)) {
        return impl.kernels.counts_tests ? make_counted_curves(impl, index)
                                         : make_curves(impl, index);
    }
    if (is_mesh(impl.scene->primitives[static_cast<size_t>(index)])) {
        if (impl.kernels.counts_tests) return make_counted_triangles(impl, index);
        return impl.kernels.user_triangles ? make_checked_triangles(impl, index)
                                           : make_triangles(impl, index);
    }
    if (!fill_shape_geometry(impl, index)) return nullptr;
    const bool points = impl.kernels.sphere_points && are_spheres(impl, index);
    return points ? make_sphere_points(impl, index) : make_shapes(impl, index);
}

}  // namespace obscura
