// crosscheck/embree_export.cpp - a scene as Embree's tutorial programs read it.
// SPDX-License-Identifier: Apache-2.0
#include "crosscheck/embree_export.h"

#include "base/atomic_file.h"
#include "crosscheck/embree_viewer.h"

#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <span>
#include <system_error>

namespace obscura::crosscheck {

namespace {

void add_primitive(const Scene& scene, int32_t index, const Affined& world, Scene& out) {
    const Primitive& primitive = scene.primitives[static_cast<size_t>(index)];
    if (!is_mesh(primitive)) return;
    Primitive flat;
    flat.first_triangle = static_cast<int32_t>(out.indices.size() / 3);
    flat.triangle_count = primitive.triangle_count;
    const auto begin = static_cast<size_t>(primitive.first_triangle) * 3;
    for (size_t i = begin; i < begin + static_cast<size_t>(primitive.triangle_count) * 3; ++i) {
        const float* at = &scene.positions[3 * static_cast<size_t>(scene.indices[i])];
        const Vec3d p = transform_point(world, Vec3d{at[0], at[1], at[2]});
        out.indices.push_back(static_cast<uint32_t>(out.positions.size() / 3));
        for (const double c : {p.x, p.y, p.z})
            out.positions.push_back(static_cast<float>(c));
    }
    out.primitives.push_back(flat);
}

Result<void> write_text(const std::filesystem::path& file, const std::string& text) {
    return write_file_atomically(file, std::as_bytes(std::span(text)));
}

}  // namespace

Scene flattened(const Scene& scene) {
    Scene out;
    out.materials.emplace_back();
    out.material_names.emplace_back();
    out.material_numbers.push_back(-1);
    for (int32_t i = 0; i < scene.world_primitive_count; ++i)
        add_primitive(scene, i, {}, out);
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
        for (int32_t i = 0; i < mesh.primitive_count; ++i) {
            add_primitive(scene,
                          mesh.first_primitive + i,
                          affine_cast<double>(instance.world_from_object),
                          out);
        }
    }
    out.world_primitive_count = static_cast<int32_t>(out.primitives.size());
    pad_tables(out);
    return out;
}

std::string wavefront_text(const Scene& flat) {
    std::string text;
    for (size_t p = 0; p < flat.primitives.size(); ++p) {
        const Primitive& primitive = flat.primitives[p];
        // Each material begins a new geometry; vertices are numbered from 1.
        fmt::format_to(std::back_inserter(text), "usemtl m{}\n", p);
        const auto begin = static_cast<size_t>(primitive.first_triangle) * 3;
        const size_t end = begin + static_cast<size_t>(primitive.triangle_count) * 3;
        for (size_t i = begin; i < end; ++i) {
            const float* at = &flat.positions[3 * static_cast<size_t>(flat.indices[i])];
            fmt::format_to(
                std::back_inserter(text), "v {:.9g} {:.9g} {:.9g}\n", at[0], at[1], at[2]);
        }
        for (size_t i = begin; i < end; i += 3)
            fmt::format_to(std::back_inserter(text), "f {} {} {}\n", i + 1, i + 2, i + 3);
    }
    return text;
}

std::optional<std::vector<std::string>> viewer_camera(const Camera& camera) {
    const bool shifted = camera.pinhole.shift_x != 0.0f || camera.pinhole.shift_y != 0.0f;
    if (camera.model != CameraModel::pinhole || is_distorted(camera) || shifted) return {};
    const auto& m = camera.world_from_camera.m;
    std::vector<std::string> out;
    const auto point = [&](const char* name, const Vec3d& p) {
        out.emplace_back(name);
        for (const double c : {p.x, p.y, p.z})
            out.push_back(fmt::format("{:.9g}", c));
    };
    const auto column = [&](int c) { return Vec3d{m[0][c], m[1][c], m[2][c]}; };
    point("--vp", column(3));
    point("--vi", column(3) - column(2));
    point("--vu", column(1));
    const double half = static_cast<double>(camera.pinhole.tan_half_yfov);
    out.emplace_back("--fov");
    out.push_back(fmt::format("{:.9g}", 2 * std::atan(half) * 180 / pi_d));
    out.emplace_back("--righthanded");
    return out;
}

std::array<int, 3> viewer_color(unsigned number) {
    const auto channel = [&](unsigned a, unsigned b, unsigned c) {
        return static_cast<int>(((number + a) * b * c) & 255U);
    };
    return {channel(13, 17, 23), channel(15, 11, 13), channel(17, 7, 19)};
}

Result<ViewerReport> export_for_embree(const Scene& scene,
                                       const Camera& camera,
                                       std::array<int, 2> size_px,
                                       const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    const Scene flat = flattened(scene);
    const std::filesystem::path mesh = std::filesystem::absolute(folder / "mesh.obj", error);
    if (auto done = write_text(mesh, wavefront_text(flat)); !done) return fail(done.error());
    const auto options = viewer_camera(camera);
    if (!options) return ViewerReport{"only pinholes without shift and distortion are compared"};
    std::string commands = "-i mesh.obj\n";
    for (const std::string& word : *options)
        commands += (word.starts_with("--") && commands.back() != '\n' ? "\n" : "") + word + ' ';
    commands += fmt::format("\n--size {} {}\n", 2 * size_px[0], 2 * size_px[1]);
    if (auto done = write_text(folder / "mesh.ecs", commands); !done) return fail(done.error());
    if (flat.primitives.empty()) return ViewerReport{"there are no triangles"};
    return compare_with_viewer({flat, camera, size_px, mesh, *options});
}

}  // namespace obscura::crosscheck
