// stages/shared_faces.cpp - faces of several bodies in one place, which a path crosses at once.
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

/// True for the same triangle or shape in the same place.
bool is_same_face(const Crossing& a, const Crossing& b) {
    return identity(a) == identity(b);
}

bool is_before(const Crossing& a, const Crossing& b) {
    return a.t < b.t || (a.t == b.t && identity(a) < identity(b));
}

/// The first face that the path has not gone through yet, and all in company with it.
std::span<const Crossing> first_company(const Probe& probe, std::vector<Crossing>& faces) {
    // Behind the path's start: it has gone through these before.
    std::erase_if(faces, [&](const Crossing& face) {
        return face.t < probe.depth && probe.depth - face.t >= probe.height;
    });
    std::sort(faces.begin(), faces.end(), is_before);
    size_t count = 1;
    while (count < faces.size() &&
           faces[count].t - faces[count - 1].t <= company_distance * probe.clearance) {
        ++count;
    }
    return {faces.data(), std::min(count, faces.size())};
}

/// What becomes of one body. Several faces of it that all lead in or all lead out are one boundary
/// met on an edge; out of it and into it again is no boundary at all.
struct Change {
    int32_t body = 0;
    bool enters = false;
    bool leaves = false;
    bool counts() const { return enters != leaves; }
};

/// The greatest number first.
std::vector<Change> find_changes(std::span<const Crossing> faces) {
    std::vector<Change> changes;
    for (const Crossing& face : faces) {
        auto at = std::find_if(changes.begin(), changes.end(), [&](const Change& change) {
            return change.body == face.body;
        });
        if (at == changes.end()) at = changes.insert(at, {face.body});
        (face.enters ? at->enters : at->leaves) = true;
    }
    std::erase_if(changes, [](const Change& change) { return !change.counts(); });
    std::sort(changes.begin(), changes.end(), [](const Change& a, const Change& b) {
        return a.body > b.body;
    });
    return changes;
}

/// As PathRows::bodies holds them: three at most.
void add_body(int32_t body, uint32_t& bodies) {
    if ((bodies & 0xFFU) != 0) return;
    const auto number = static_cast<uint32_t>(body);
    if ((bodies >> 16U & 0xFFU) == 0) {
        bodies |= number << 16U;
    } else {
        bodies |= (bodies >> 8U & 0xFFU) == 0 ? number << 8U : number;
    }
}

}  // namespace

Company find_company(const Probe& probe, const Crossing& hit, std::vector<Crossing>& faces) {
    std::erase_if(faces, [&](const Crossing& face) { return is_same_face(face, hit); });
    faces.push_back(hit);
    const std::span<const Crossing> company = first_company(probe, faces);
    Company out;
    out.found = std::any_of(company.begin(), company.end(), [&](const Crossing& face) {
        return face.body != hit.body || face.enters != hit.enters;
    });
    if (!out.found) return out;
    out.crossed.left = faces_shared;
    const std::vector<Change> changes = find_changes(company);
    for (const Change& change : changes)
        add_body(change.body, change.enters ? out.crossed.entered : out.crossed.left);
    // Where nothing changes, any face is as good: nothing will be seen of it.
    const auto rank = [&](const Crossing& face) {
        const bool fills = !changes.empty() && face.body == changes.front().body;
        return std::make_tuple(fills ? 0 : 1, identity(face));
    };
    out.face = *std::min_element(
        company.begin(), company.end(), [&](const Crossing& a, const Crossing& b) {
            return rank(a) < rank(b);
        });
    out.crossed.before = out.face.t - company.front().t + probe.clearance;
    out.crossed.beyond = company.back().t - out.face.t + probe.clearance;
    return out;
}

namespace {

/// One ray of paths or probes, alone.
template <typename Rows>
RayColumns ray_of(const Rows& rows, size_t row, const float* tfar, const float* slot_time) {
    return {.ox = rows.ox + row,
            .oy = rows.oy + row,
            .oz = rows.oz + row,
            .dx = rows.dx + row,
            .dy = rows.dy + row,
            .dz = rows.dz + row,
            .tfar = tfar,
            .key = rows.path_key + row,
            .count = 1,
            .time = slot_time != nullptr ? slot_time + rows.slot[row] : nullptr};
}

/// All faces of bodies along one ray of a slot's path.
void list_faces(const CompanyQuery& query,
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

/// Puts a face in the place of a path's hit.
///
/// In   faces: all that the path's ray goes through up to there; it may miss the face by rounding
void move_hit(const HitRows& h, size_t row, Crossing face, const std::vector<Crossing>& faces) {
    face.t = h.t[row];
    for (const Crossing& met : faces) {
        if (is_same_face(met, face)) face = met;
    }
    h.t[row] = face.t;
    h.u[row] = face.u;
    h.v[row] = face.v;
    h.instance[row] = face.surface.instance;
    h.primitive[row] = face.surface.primitive;
    h.triangle[row] = face.triangle;
}

}  // namespace

int meet_company(const CompanyQuery& query,
                 int probes,
                 const ProbeRows& rows,
                 const HitRows& hits,
                 SharedFaces* shared) {
    int met = 0;
    const ShadowView p = rows.probes;
    const HitRows& h = hits;
    std::vector<Crossing> faces;
    for (size_t i = 0; i < static_cast<size_t>(probes); ++i) {
        const size_t row = rows.row[i] & ~seen_from_front;
        const SceneRows surface{h.instance[row], h.primitive[row]};
        const Crossing hit{p.r[i],
                           h.u[row],
                           h.v[row],
                           surface,
                           h.triangle[row],
                           query.touching_bodies[surface.primitive],
                           (rows.row[i] & seen_from_front) != 0};
        list_faces(query, ray_of(p, i, p.tfar + i, rows.time), p.slot + i, faces);
        const Company company = find_company({p.r[i], p.g[i], p.b[i]}, hit, faces);
        if (!company.found) continue;
        ++met;
        shared[p.slot[i]] = company.crossed;
        const float tfar = h.t[row] * 1.001f;  // a little beyond: the face may lie behind the hit
        list_faces(query, ray_of(rows.paths, row, &tfar, rows.time), p.slot + i, faces);
        move_hit(h, row, company.face, faces);
    }
    return met;
}

}  // namespace obscura
