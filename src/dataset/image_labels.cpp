// dataset/image_labels.cpp - the labels of one image: its camera, and each object in it.
// SPDX-License-Identifier: Apache-2.0
#include "dataset/image_labels.h"

#include <algorithm>

namespace obscura::dataset {

namespace {

void extend(std::optional<PixelBox>& box, int x, int y) {
    if (!box) {
        box = PixelBox{x, y, 1, 1};
        return;
    }
    const int right = std::max(box->left + box->width, x + 1);
    const int bottom = std::max(box->top + box->height, y + 1);
    box->left = std::min(box->left, x);
    box->top = std::min(box->top, y);
    box->width = right - box->left;
    box->height = bottom - box->top;
}

}  // namespace

std::vector<ObjectLabel> label_objects(const RayLabels& rays, const Scene& scene) {
    std::vector<ObjectLabel> out;
    const auto columns = static_cast<uint32_t>(rays.frame.width);
    for (const Silhouette& silhouette : rays.silhouettes) {
        ObjectLabel label;
        label.node = silhouette.node;
        label.silhouette = &silhouette;
        label.pixels = silhouette.pixels.size();
        for (const uint32_t pixel : silhouette.pixels) {
            const int x = rays.frame.x + static_cast<int>(pixel % columns);
            const int y = rays.frame.y + static_cast<int>(pixel / columns);
            extend(label.box, x, y);
            if (!rays.is_inside(pixel)) continue;
            ++label.pixels_inside;
            if (rays.node[rays.image_index(pixel)] != label.node) continue;
            ++label.visible_pixels;
            extend(label.visible_box, x, y);
        }
        if (label.pixels_inside == 0) continue;
        label.pose = rigid_pose(scene.node_places[static_cast<size_t>(label.node)].world_from_mesh);
        out.push_back(label);
    }
    return out;
}

Masks masks_of(const RayLabels& rays, const ObjectLabel& object) {
    Masks out;
    for (const uint32_t pixel : object.silhouette->pixels) {
        if (!rays.is_inside(pixel)) continue;
        const size_t index = rays.image_index(pixel);
        out.all.push_back(static_cast<uint32_t>(index));
        if (rays.node[index] == object.node) out.visible.push_back(static_cast<uint32_t>(index));
    }
    return out;
}

}  // namespace obscura::dataset
