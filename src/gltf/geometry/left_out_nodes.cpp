// gltf/geometry/left_out_nodes.cpp - leaves out or stops instances that rays cannot enter.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/geometry/left_out_nodes.h"

#include "gltf/parse/list_text.h"
#include "gltf/parse/node_graph.h"
#include "scene/coincident_instances.h"
#include "scene/frame_motion.h"
#include "scene/ray_reach.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace obscura::gltf {

namespace {

/// Names the nodes of instances. An instance on an animated node may lack one.
std::string node_names(const Document& document,
                       const Scene& scene,
                       const std::vector<Instance>& instances) {
    NameList names;
    for (const Instance& instance : instances) {
        const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
        const Primitive& first = scene.primitives[static_cast<size_t>(mesh.first_primitive)];
        const int node = instance.node >= 0 ? instance.node : first.node;
        names.add(node >= 0 ? node_label(document, node) : "an animated node");
    }
    return names.text();
}

void leave_out_of_scene(const Document& document, Scene& scene, Log& log) {
    const UnreachedInstances unreached = leave_out_unreached(scene);
    if (!unreached.left_out.empty()) {
        log.warn(document.file,
                 "nodes whose scale is so small or large, beside the size of the scene, that "
                 "single precision cannot invert it, are not drawn: " +
                     node_names(document, scene, unreached.left_out));
    }
    if (!unreached.halted.empty()) {
        log.warn(document.file,
                 "nodes that turn or shrink so far while the shutter is open that they would "
                 "pass through a plane stand still: " +
                     node_names(document, scene, unreached.halted));
    }
    const std::vector<Instance> copies = leave_out_copies(scene);
    if (!copies.empty()) {
        log.warn(document.file,
                 std::to_string(copies.size()) +
                     " copies of meshes that lie exactly on others are not drawn; nodes: " +
                     node_names(document, scene, copies));
    }
}

}  // namespace

void leave_out_nodes(const Document& document, Scene& scene, Log& log) {
    if (scene.frame_motion == nullptr) return leave_out_of_scene(document, scene, log);
    const std::vector<Instance> before = scene.instances;
    leave_out_of_scene(document, scene, log);
    if (scene.instances.size() == before.size()) return;
    FrameMotion motion = *scene.frame_motion;
    leave_out_frames(before, scene.instances, motion);
    scene.frame_motion = std::make_shared<const FrameMotion>(std::move(motion));
}

}  // namespace obscura::gltf
