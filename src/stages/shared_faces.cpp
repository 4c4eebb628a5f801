// stages/shared_faces.cpp - coincident faces of several media, which a path crosses all at once.
// SPDX-License-Identifier: Apache-2.0
#include "stages/shared_faces.h"

#include <algorithm>
#include <span>
#include <tuple>

namespace obscura {

namespace {

auto identity(const Crossing& face) {
    return std::tie(face.surface.primitive, face.surface.instance, face.triangle);
}

/// True for the same triangle or shape of the same instance.
bool is_same_face(const Crossing& a, const Crossing& b) {
    return identity(a) == identity(b);
}

bool is_before(const Crossing& a, const Crossing& b) {
    return a.t < b.t || (a.t == b.t && identity(a) < identity(b));
}

/// The first face that the path has not crossed yet, and all faces that coincide with it.
std::span<const Crossing> first_coincident_faces(const Probe& probe, std::vector<Crossing>& faces) {
    // These lie behind the path's start: it has already crossed them.
    std::erase_if(faces, [&](const Crossing& face) {
        return face.t < probe.depth && probe.depth - face.t >= probe.height;
    });
    std::sort(faces.begin(), faces.end(), is_before);
    size_t count = 1;
    while (count < faces.size() &&
           faces[count].t - faces[count - 1].t <= coincidence_distance * probe.clearance) {
        ++count;
    }
    return {faces.data(), std::min(count, faces.size())};
}

/// The change of one medium. Several faces that all enter or all leave it are one boundary, met at
/// an edge; leaving and entering again cancel.
struct Change {
    int32_t medium = 0;
    bool enters = false;
    bool leaves = false;
    bool counts() const { return enters != leaves; }
};

/// Changes of the media at these faces, the greatest number first.
std::vector<Change> find_changes(std::span<const Crossing> faces) {
    std::vector<Change> changes;
    for (const Crossing& face : faces) {
        auto at = std::find_if(changes.begin(), changes.end(), [&](const Change& change) {
            return change.medium == face.medium;
        });
        if (at == changes.end()) at = changes.insert(at, {face.medium});
        (face.enters ? at->enters : at->leaves) = true;
    }
    std::erase_if(changes, [](const Change& change) { return !change.counts(); });
    std::sort(changes.begin(), changes.end(), [](const Change& a, const Change& b) {
        return a.medium > b.medium;
    });
    return changes;
}

/// Appends a medium, in the format of PathColumns::medium_stack: three at most.
void add_medium(int32_t medium, uint32_t& medium_stack) {
    if ((medium_stack & 0xFFU) != 0) return;
    const auto number = static_cast<uint32_t>(medium);
    if ((medium_stack >> 16U & 0xFFU) == 0) {
        medium_stack |= number << 16U;
    } else {
        medium_stack |= (medium_stack >> 8U & 0xFFU) == 0 ? number << 8U : number;
    }
}

}  // namespace

CoincidentFaces find_coincident_faces(const Probe& probe,
                                      const Crossing& hit,
                                      std::vector<Crossing>& faces) {
    std::erase_if(faces, [&](const Crossing& face) { return is_same_face(face, hit); });
    faces.push_back(hit);
    const std::span<const Crossing> coincident = first_coincident_faces(probe, faces);
    CoincidentFaces out;
    out.found = std::any_of(coincident.begin(), coincident.end(), [&](const Crossing& face) {
        return face.medium != hit.medium || face.enters != hit.enters;
    });
    if (!out.found) return out;
    out.crossed.left = faces_shared;
    const std::vector<Change> changes = find_changes(coincident);
    for (const Change& change : changes)
        add_medium(change.medium, change.enters ? out.crossed.entered : out.crossed.left);
    // Where nothing changes, any face will do: it stays invisible.
    const auto rank = [&](const Crossing& face) {
        const bool dominates = !changes.empty() && face.medium == changes.front().medium;
        return std::make_tuple(dominates ? 0 : 1, identity(face));
    };
    out.face = *std::min_element(
        coincident.begin(), coincident.end(), [&](const Crossing& a, const Crossing& b) {
            return rank(a) < rank(b);
        });
    out.crossed.reflected_clearance = out.face.t - coincident.front().t + probe.clearance;
    out.crossed.transmitted_clearance = coincident.back().t - out.face.t + probe.clearance;
    return out;
}

namespace {

/// One ray of a column of paths or probes.
template <typename Columns>
RayColumns ray_of(const Columns& columns, size_t index, const float* tfar, const float* slot_time) {
    return {.ox = columns.ox + index,
            .oy = columns.oy + index,
            .oz = columns.oz + index,
            .dx = columns.dx + index,
            .dy = columns.dy + index,
            .dz = columns.dz + index,
            .tfar = tfar,
            .key = columns.path_key + index,
            .count = 1,
            .time = slot_time != nullptr ? slot_time + columns.slot[index] : nullptr};
}

/// All faces of media along one ray of a sample's path.
void list_faces(const CoincidenceQuery& query,
                const RayColumns& ray,
                const uint32_t* slot,
                std::vector<Crossing>& out) {
    SeeThrough see_through = query.see_through;
    Cutaway cutaway;
    if (see_through.cutaway != nullptr) {
        cutaway = {see_through.cutaway->faces, slot};
        see_through.cutaway = &cutaway;
    }
    out.clear();
    query.accel.list_crossings(ray, 0, see_through, out);
}

/// Replaces a path's hit by a face.
///
/// In   faces: all that the path's ray crosses up to there; rounding may make it miss the face
void move_hit(const HitColumns& h,
              size_t index,
              Crossing face,
              const std::vector<Crossing>& faces) {
    face.t = h.t[index];
    for (const Crossing& met : faces) {
        if (is_same_face(met, face)) face = met;
    }
    h.t[index] = face.t;
    h.u[index] = face.u;
    h.v[index] = face.v;
    h.instance[index] = face.surface.instance;
    h.primitive[index] = face.surface.primitive;
    h.triangle[index] = face.triangle;
}

}  // namespace

int resolve_coincident_faces(const CoincidenceQuery& query,
                             int probes,
                             const ProbeColumns& columns,
                             const HitColumns& hits,
                             SharedFaces* shared) {
    int met = 0;
    const ShadowView p = columns.probes;
    const HitColumns& h = hits;
    std::vector<Crossing> faces;
    for (size_t i = 0; i < static_cast<size_t>(probes); ++i) {
        const size_t index = columns.path_index[i] & ~seen_from_front;
        const SceneRecords surface{h.instance[index], h.primitive[index]};
        const Crossing hit{p.r[i],
                           h.u[index],
                           h.v[index],
                           surface,
                           h.triangle[index],
                           query.touching_media[surface.primitive],
                           (columns.path_index[i] & seen_from_front) != 0};
        list_faces(query, ray_of(p, i, p.tfar + i, columns.time), p.slot + i, faces);
        const CoincidentFaces coincident =
            find_coincident_faces({p.r[i], p.g[i], p.b[i]}, hit, faces);
        if (!coincident.found) continue;
        ++met;
        shared[p.slot[i]] = coincident.crossed;
        // A little further: the face may lie behind the hit.
        const float tfar = h.t[index] * 1.001f;
        list_faces(query, ray_of(columns.paths, index, &tfar, columns.time), p.slot + i, faces);
        move_hit(h, index, coincident.face, faces);
    }
    return met;
}

}  // namespace obscura
