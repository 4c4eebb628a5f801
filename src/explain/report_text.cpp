// explain/report_text.cpp - the report of one pixel as text: every step with its numbers.
// SPDX-License-Identifier: Apache-2.0
#include "explain/explain_pixel.h"

#include <algorithm>
#include <fmt/format.h>

namespace obscura {

namespace {

constexpr size_t widest = 100;

Vec3d wide(const Vec3f& v) {
    return {v.x, v.y, v.z};
}

std::string value_of(const Vec3f& v) {
    return fmt::format("({:.7g}, {:.7g}, {:.7g})", v.x, v.y, v.z);
}

/// Terms side by side, in lines that are not too wide.
std::string flow(const std::vector<Term>& terms, const std::string& indent) {
    std::string out;
    std::string line;
    for (const Term& term : terms) {
        const std::string text = format_term(term);
        if (!line.empty() && indent.size() + line.size() + 3 + text.size() > widest) {
            out += indent + line + "\n";
            line.clear();
        }
        line += (line.empty() ? "" : "   ") + text;
    }
    return line.empty() ? out : out + indent + line + "\n";
}

std::string list_of(const std::vector<double>& numbers) {
    std::string out;
    for (const double number : numbers)
        out += (out.empty() ? "" : " and ") + format_number(number);
    return out;
}

std::string ray_text(const CameraWorking& working) {
    std::string out = "\nray (" + working.model + ")\n";
    for (const Term& term : working.terms)
        out += "  " + format_term(term) + "\n";
    if (!working.sees) out += "  the camera shows nothing here: there is no ray\n";
    return out;
}

std::string object_text(const Candidate& object) {
    const bool met = std::isfinite(object.t);
    std::string out = fmt::format(
        "  {:<16} {}{}\n",
        met ? "t = " + format_number(object.t) : "-",
        object.name,
        object.fate == Fate::seen ? ": SEEN" : std::string(": ") + fate_name(object.fate));
    if (!object.note.empty()) out += "      " + object.note + "\n";
    out += "      " + object.working.equation + "\n";
    if (object.moved) {
        out += flow({{"R_o in its space", object.moved->origin},
                     {"R_d in its space", object.moved->direction}},
                    "      ");
    }
    out += flow(object.working.terms, "      ");
    if (!object.working.missed.empty()) out += "      " + object.working.missed + "\n";
    if (!object.working.t.empty()) out += "      t = " + list_of(object.working.t) + "\n";
    return out;
}

std::string objects_text(const PixelReport& report) {
    std::string out = "\nobjects\n";
    for (const Candidate& object : report.objects)
        out += object_text(object);
    if (report.more_near + report.elsewhere > 0) {
        out +=
            fmt::format("  and {} more whose boxes the ray meets, {} that it does not come near\n",
                        report.more_near,
                        report.elsewhere);
    }
    return out;
}

std::string renderer_text(const PixelReport& report) {
    const RaycastNotes& r = report.renderer;
    std::string out = "  the renderer (single precision): ";
    if (r.primitive < 0) {
        out += "nothing";
    } else {
        out += fmt::format("t = {:.9g}, {}", r.t, report.renderer_item);
    }
    if (r.passes < 1) {
        out += fmt::format("; Gaussian splats before it leave {:.7g} of its light", r.passes);
    }
    if (report.disagrees) out += "; not what double precision says: rounding decides at an edge";
    return out + "\n";
}

std::string seen_text(const PixelReport& report) {
    if (!report.seen) return "\nseen: nothing\n" + renderer_text(report);
    const SeenPoint& seen = *report.seen;
    const Candidate& object = report.objects[seen.object];
    const Vec3d to_eye = report.working.ray.direction * -1.0;
    std::string out = "\nseen: " + object.name + "\n" + renderer_text(report);
    out += "  P = R(t) = " + format_value(seen.position) + "\n";
    out += "  normal of the surface = " + format_value(seen.face) + "\n";
    out += "  N, for shading = " + format_value(seen.normal, 7) +
           "   N . V = " + format_number(dot(seen.normal, to_eye), 7) + "\n";
    out += fmt::format("  texture coordinates ({:.7g}, {:.7g})\n", seen.uv[0], seen.uv[1]);
    out += fmt::format("  material '{}': base colour {}, {}\n",
                       seen.material,
                       value_of(seen.base_color),
                       seen.surface);
    return out;
}

std::string light_text(const LightContribution& light) {
    std::string out = "  " + light.name + "\n";
    std::vector<Term> terms = light.terms;
    terms.insert(terms.begin(), {"L", light.direction});
    terms.emplace_back(light.formula, light.irradiance);
    terms.emplace_back("N . L", light.cosine);
    if (light.noted.asked) {
        terms.emplace_back("f", light.bsdf);
        terms.emplace_back("f E N . L", wide(light.noted.offered));
    }
    out += flow(terms, "      ");
    if (!light.noted.asked) {
        return out + (light.cosine > 0 ? "      nothing of it is reflected to the eye\n"
                                       : "      it is behind the surface\n");
    }
    if (!light.blocked_by.empty()) return out + "      in the shadow of " + light.blocked_by + "\n";
    return out + "      arrives: " + value_of(light.noted.arrived) + "\n";
}

std::string sum_text(const PixelReport& report) {
    std::string out = "\nlight\n";
    if (report.renderer.primitive < 0) {
        out += "  the background and splats\n";
    } else {
        out += "  emission, surroundings, headlight and splats, without shadows: " +
               value_of(report.renderer.unshadowed) + "\n";
    }
    for (const LightContribution& light : report.lights)
        out += light_text(light);
    return out + fmt::format("  pixel, the sum = ({:.9g}, {:.9g}, {:.9g}), alpha {:g}\n",
                             report.rgba[0],
                             report.rgba[1],
                             report.rgba[2],
                             report.rgba[3]);
}

}  // namespace

std::string pixel_text(const PixelReport& report) {
    const PixelPlace& p = report.pixel;
    std::string out = fmt::format("pixel ({}, {}) of {} x {}: {}, {}\n",
                                  p.x,
                                  p.y,
                                  p.width,
                                  p.height,
                                  report.file,
                                  report.camera);
    out += ray_text(report.working);
    if (!report.working.sees) return out;
    return out + objects_text(report) + seen_text(report) + sum_text(report);
}

}  // namespace obscura
