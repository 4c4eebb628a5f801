// explain/pixel_report.h - data about one pixel, before it becomes text or a drawing.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "crosscheck/truth.h"
#include "explain/camera_working.h"
#include "explain/workings.h"
#include "stages/raycast_notes.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace obscura {

/// How the ray treats an object.
enum class Fate {
    seen,    ///< the nearest hit
    hidden,  ///< behind the nearest hit
    passed,  ///< nearer, but camera rays go through it: the back of a single-sided face, alpha
    beyond,  ///< further away than the ray's end
    before,  ///< the line meets it behind the ray's origin only
    missed
};

const char* fate_name(Fate fate);

/// An object near the ray.
struct Candidate {
    crosscheck::Item item;
    std::string name;  ///< "sphere of node 2 'Ball'"
    /// The ray in the object's space, if that is another.
    std::optional<crosscheck::TrueRay> moved;
    Working working;
    double t = INFINITY;  ///< where the ray meets it; infinite: nowhere
    Fate fate = Fate::missed;
    std::string note;  ///< why it was passed
};

/// The hit: object, position, material.
struct SeenPoint {
    size_t object = 0;  ///< number of the candidate
    Vec3d position = {0, 0, 0};
    Vec3d face = {0, 0, 0};    ///< unit normal of the geometry, on the viewer's side
    Vec3d normal = {0, 0, 0};  ///< unit normal of shading, likewise; the renderer's
    std::array<float, 2> uv = {0, 0};
    Vec3f base_color = {0, 0, 0};  ///< textures included; the renderer's
    std::string material;          ///< name, or "default material"
    std::string surface;           ///< "metallic 0, roughness 0.5", layers, textures
};

/// One light's contribution.
struct LightContribution {
    std::string name;
    std::vector<Term> terms;  ///< its numbers in the formula
    std::string formula;      ///< of E
    Vec3d direction = {0, 0, 0};
    double distance_m = INFINITY;
    Vec3d irradiance = {0, 0, 0};  ///< E of a surface that faces the light
    double cosine = 0;             ///< N . L
    Vec3d bsdf = {0, 0, 0};        ///< what the material reflects of it: offered / (E N . L), as if
                                   ///< no splats were in front of it
    NotedLight noted;              ///< what the renderer made of it
    std::string blocked_by;        ///< empty: nothing is in the way
};

struct PixelReport {
    std::string file, camera;
    PixelPlace pixel;
    CameraWorking working;
    std::vector<Candidate> objects;  ///< those that are met, nearest first; then the others
    size_t more_near = 0;            ///< objects whose boxes the ray meets, not listed
    size_t elsewhere = 0;            ///< all others
    std::optional<SeenPoint> seen;
    RaycastNotes renderer;  ///< its own ray, hit and contributions, in single precision
    std::string renderer_item;
    /// In double precision another object is nearest: rounding decides at an edge.
    bool disagrees = false;
    std::vector<LightContribution> lights;
    std::array<float, 4> rgba = {0, 0, 0, 0};  ///< the pixel of --integrator raycast
    std::string drawing;                       ///< SVG, where it was asked for
};

}  // namespace obscura
