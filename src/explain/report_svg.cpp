// explain/report_svg.cpp - draws one pixel's report: the plane of the ray and the normal.
// SPDX-License-Identifier: Apache-2.0
#include "explain/report_svg.h"

#include "base/xml_text.h"
#include "explain/cross_section.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace obscura {

namespace {

constexpr double image_width = 960, plot_height = 460, margin = 20, line_height = 18;
constexpr size_t widest_line = 118;  ///< characters of the legend
constexpr const char* ground = "#fdfcf8";
constexpr const char* ink = "#222222";
constexpr const char* ray_color = "#c0392b";
constexpr const char* seen_color = "#1f4e8c";
constexpr const char* other_color = "#8a8a8a";
constexpr const char* normal_color = "#1e7d34";
constexpr const char* light_color = "#b36b00";
constexpr const char* shadow_color = "#666666";

/// A position in the drawing, pixels.
struct Spot {
    double x, y;
};

class Drawing {
public:
    explicit Drawing(const CrossSection& plane)
        : plane_(plane), scale_(image_width / (plane.x_high - plane.x_low)) {}

    Spot spot(const PlanePoint& p) const {
        return {(p.x - plane_.x_low) * scale_, 0.5 * plot_height - p.y * scale_};
    }
    Spot spot(const Vec3d& p) const { return spot(plane_.project(p)); }

    void line(const Spot& a, const Spot& b, const std::string& style) {
        out_ += fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n",
                            a.x,
                            a.y,
                            b.x,
                            b.y,
                            style);
    }
    void arrow(const Spot& from, const Spot& to, const char* color, const char* more) {
        line(from, to, fmt::format("stroke=\"{}\" stroke-width=\"2.5\"{}", color, more));
        const double length = std::hypot(to.x - from.x, to.y - from.y);
        if (!(length > 1)) return;
        const Spot along{(to.x - from.x) / length * 9, (to.y - from.y) / length * 9};
        out_ +=
            fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}L{:.1f} {:.1f}Z\" fill=\"{}\"/>\n",
                        to.x + along.x,
                        to.y + along.y,
                        to.x - 0.5 * along.y,
                        to.y + 0.5 * along.x,
                        to.x + 0.5 * along.y,
                        to.y - 0.5 * along.x,
                        color);
    }
    void text(const Spot& at, const char* color, const std::string& words, const char* more = "") {
        out_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" fill=\"{}\"{}>{}</text>\n",
                            at.x,
                            at.y,
                            color,
                            more,
                            escape_xml(words));
    }
    void dot(const Spot& at, double radius, const char* fill, const char* stroke) {
        out_ += fmt::format(
            "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:g}\" fill=\"{}\" stroke=\"{}\" "
            "stroke-width=\"1.5\"/>\n",
            at.x,
            at.y,
            radius,
            fill,
            stroke);
    }
    void outline(const Outline& outline, const std::string& style) {
        out_ += "<path d=\"";
        for (const PlaneSegment& s : outline.segments) {
            const Spot a = spot(s.from);
            const Spot b = spot(s.to);
            out_ += fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", a.x, a.y, b.x, b.y);
        }
        out_ += "\" fill=\"none\" " + style + "/>\n";
    }
    bool shows(double x) const { return x >= plane_.x_low && x <= plane_.x_high; }
    const CrossSection& plane() const { return plane_; }
    std::string take() { return std::move(out_); }
    void raw(const std::string& element) { out_ += element; }

private:
    const CrossSection& plane_;
    double scale_;
    std::string out_;
};

const Candidate* listed(const PixelReport& report, const crosscheck::Item& item) {
    for (const Candidate& object : report.objects) {
        if (object.item == item) return &object;
    }
    return nullptr;
}

void draw_objects(const PixelReport& report, Drawing& draw) {
    for (const bool in_front : {false, true}) {
        for (const Outline& outline : draw.plane().outlines) {
            const Candidate* object = listed(report, outline.item);
            const bool seen = object != nullptr && object->fate == Fate::seen;
            if (seen != in_front) continue;
            const bool passed = object != nullptr && object->fate == Fate::passed;
            draw.outline(outline,
                         fmt::format("stroke=\"{}\" stroke-width=\"{}\"{}",
                                     seen ? seen_color : other_color,
                                     seen ? "3.5" : "1.8",
                                     passed ? " stroke-dasharray=\"6 4\"" : ""));
        }
    }
}

/// Names shapes, and meshes of few faces, each at its highest point.
void draw_names(const PixelReport& report, Drawing& draw) {
    constexpr size_t max_names = 12;
    std::vector<std::string> known;
    for (const Outline& outline : draw.plane().outlines) {
        const Candidate* object = listed(report, outline.item);
        const size_t quote = object == nullptr ? std::string::npos : object->name.find('\'');
        if (quote == std::string::npos || known.size() == max_names) continue;
        const std::string name = object->name.substr(quote + 1, object->name.size() - quote - 2);
        if (std::find(known.begin(), known.end(), name) != known.end()) continue;
        known.push_back(name);
        Spot top = draw.spot(outline.segments.front().from);
        for (const PlaneSegment& segment : outline.segments) {
            for (const PlanePoint& end : {segment.from, segment.to}) {
                const Spot at = draw.spot(end);
                if (at.y < top.y) top = at;
            }
        }
        const bool right = top.x > 0.85 * image_width;
        draw.text({top.x + (right ? -8 : 6), std::max(top.y - 6, 16.0)},
                  object->fate == Fate::seen ? seen_color : shadow_color,
                  name,
                  right ? " text-anchor=\"end\"" : "");
    }
}

void draw_ray(const PixelReport& report, Drawing& draw) {
    const CrossSection& plane = draw.plane();
    const bool eye = plane.x_low < 0;
    const Spot start = draw.spot(PlanePoint{std::max(plane.x_low, 0.0), 0});
    const Spot end = draw.spot(PlanePoint{plane.x_high, 0});
    const Spot stop = report.seen ? draw.spot(report.seen->position) : end;
    const std::string style = fmt::format("stroke=\"{}\" stroke-width=\"2.5\"", ray_color);
    draw.line(start, stop, style);
    if (report.seen) draw.line(stop, end, style + " stroke-dasharray=\"3 6\" opacity=\"0.6\"");
    if (eye) {
        draw.dot(start, 6, ray_color, ground);
        draw.text({start.x + 2, start.y - 14}, ray_color, "R_o");
    } else {
        draw.text(
            {8, start.y - 10}, ray_color, fmt::format("R_o is {:.4g} m to the left", plane.x_low));
    }
    draw.text({end.x - 10, end.y + 22}, ray_color, "R_d", " text-anchor=\"end\"");
}

/// A numbered dot at each hit: the object's number in the legend.
void draw_hits(const PixelReport& report, Drawing& draw) {
    double last_x = -INFINITY;
    double lift = 0;
    for (size_t i = 0; i < report.objects.size(); ++i) {
        const Candidate& object = report.objects[i];
        if (!std::isfinite(object.t)) continue;
        for (const double t : object.working.t) {
            if (!(t > 0) || !draw.shows(t)) continue;
            const Spot at = draw.spot(PlanePoint{t, 0});
            const bool first = t == object.t && object.fate == Fate::seen;
            draw.dot(at, 4, first ? seen_color : ground, first ? seen_color : ink);
            lift = std::abs(at.x - last_x) < 16 ? lift + 15 : 0;
            last_x = at.x;
            draw.text({at.x, at.y + 20 + lift},
                      first ? seen_color : ink,
                      std::to_string(i + 1),
                      " text-anchor=\"middle\" font-weight=\"bold\"");
        }
    }
}

/// An arrow from what is seen.
struct Arrow {
    Vec3d direction;
    std::string name;
    const char* color;
    const char* more = "";  ///< further attributes of the line
};

/// A direction that leaves the plane is drawn foreshortened.
void draw_direction(const Spot& from, const Arrow& arrow, Drawing& draw) {
    constexpr double arrow_length = 105;
    const CrossSection& plane = draw.plane();
    const double x = dot(arrow.direction, plane.along);
    const double y = dot(arrow.direction, plane.across);
    const Spot to{from.x + arrow_length * x, from.y - arrow_length * y};
    draw.arrow(from, to, arrow.color, arrow.more);
    const double size = std::max(std::hypot(x, y), 1e-9);
    const Spot label{to.x + 20 * x / size, to.y - 20 * y / size + 5};
    draw.text(label, arrow.color, arrow.name, " text-anchor=\"middle\" font-weight=\"bold\"");
}

void draw_directions(const PixelReport& report, Drawing& draw) {
    if (!report.seen) return;
    const Spot at = draw.spot(report.seen->position);
    constexpr size_t max_lights = 6;
    for (size_t i = 0; i < std::min(report.lights.size(), max_lights); ++i) {
        const LightContribution& light = report.lights[i];
        const bool lit = light.noted.asked && light.blocked_by.empty();
        draw_direction(at,
                       {.direction = light.direction,
                        .name = fmt::format("L{}", light.noted.number),
                        .color = lit ? light_color : shadow_color,
                        .more = lit ? "" : " stroke-dasharray=\"5 4\""},
                       draw);
    }
    draw_direction(
        at, {.direction = report.seen->normal, .name = "N", .color = normal_color}, draw);
}

/// Adds words to the legend, as many a line as fit.
void add_wrapped(const std::vector<std::string>& words,
                 const std::string& indent,
                 std::vector<std::string>& lines) {
    std::string line = indent;
    for (const std::string& word : words) {
        if (line.size() > indent.size() && line.size() + word.size() > widest_line) {
            lines.push_back(line);
            line = indent;
        }
        line += (line.size() > indent.size() ? "   " : "") + word;
    }
    if (line.size() > indent.size()) lines.push_back(line);
}

std::vector<std::string> words_of(const std::vector<Term>& terms) {
    std::vector<std::string> words;
    for (const Term& term : terms)
        words.push_back(format_term(term, 5));
    return words;
}

void list_lights(const PixelReport& report, std::vector<std::string>& lines) {
    constexpr size_t max_lights = 6;
    for (size_t i = 0; i < std::min(report.lights.size(), max_lights); ++i) {
        const LightContribution& light = report.lights[i];
        std::vector<std::string> words = {fmt::format("L{}  {}", light.noted.number, light.name)};
        words.push_back(fmt::format("N . L = {:.5g}", light.cosine));
        words.push_back(light.formula + " = " + format_value(light.irradiance, 5));
        const Vec3d offered{light.noted.offered.x, light.noted.offered.y, light.noted.offered.z};
        words.push_back(!light.blocked_by.empty() ? "in the shadow of " + light.blocked_by
                        : !light.noted.asked      ? "no light from there"
                                                  : "f E N . L = " + format_value(offered, 5));
        add_wrapped(words, "", lines);
    }
}

std::vector<std::string> legend(const PixelReport& report) {
    const PixelPlace& p = report.pixel;
    std::vector<std::string> lines = {fmt::format("Pixel ({}, {}) of {} x {}: {}, {} ({})",
                                                  p.x,
                                                  p.y,
                                                  p.width,
                                                  p.height,
                                                  report.file,
                                                  report.camera,
                                                  report.working.model)};
    if (!report.working.sees) {
        lines.emplace_back("The camera shows nothing here: there is no ray.");
        return lines;
    }
    const crosscheck::TrueRay& ray = report.working.ray;
    add_wrapped(words_of({{"R_o", ray.origin}, {"R_d", ray.direction}}), "", lines);
    for (size_t i = 0; i < report.objects.size(); ++i) {
        const Candidate& object = report.objects[i];
        if (!std::isfinite(object.t)) continue;
        lines.push_back(fmt::format(
            "{}  t = {:.6g}: {}, {}", i + 1, object.t, object.name, fate_name(object.fate)));
        if (object.fate == Fate::seen) add_wrapped(words_of(object.working.terms), "     ", lines);
    }
    if (report.seen) {
        add_wrapped(words_of({{"P", report.seen->position},
                              {"N", report.seen->normal},
                              {"N . V", -dot(report.seen->normal, ray.direction)}}),
                    "",
                    lines);
    }
    list_lights(report, lines);
    lines.push_back(fmt::format(
        "pixel = {:.6g}, {:.6g}, {:.6g}", report.rgba[0], report.rgba[1], report.rgba[2]));
    return lines;
}

}  // namespace

std::string pixel_svg(const crosscheck::TrueScene& scene, const PixelReport& report) {
    CrossSection plane;
    if (report.working.sees) plane = cut_scene(scene, report, image_width / plot_height);
    Drawing draw(plane);
    if (report.working.sees) {
        draw_objects(report, draw);
        draw_names(report, draw);
        draw_ray(report, draw);
        draw_directions(report, draw);
        draw_hits(report, draw);
    }
    const std::string plot = draw.take();
    const std::vector<std::string> lines = legend(report);
    for (size_t i = 0; i < lines.size(); ++i) {
        draw.text({0, plot_height + 30 + line_height * static_cast<double>(i)},
                  ink,
                  lines[i],
                  " xml:space=\"preserve\"");
    }
    const double width = image_width + 2 * margin;
    const double height =
        plot_height + 2 * margin + 20 + line_height * static_cast<double>(lines.size());
    return fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {1:g}\" width=\"{0:g}\" "
        "height=\"{1:g}\" font-family=\"sans-serif\" font-size=\"13\">\n"
        "<title>{2}</title>\n"
        "<rect width=\"{0:g}\" height=\"{1:g}\" fill=\"{3}\"/>\n"
        "<clipPath id=\"plot\"><rect width=\"{4:g}\" height=\"{5:g}\"/></clipPath>\n"
        "<g transform=\"translate({6:g} {6:g})\">\n"
        "<rect width=\"{4:g}\" height=\"{5:g}\" fill=\"#ffffff\" stroke=\"#cccccc\"/>\n"
        "<g clip-path=\"url(#plot)\" font-size=\"15\">\n{7}</g>\n{8}</g>\n</svg>\n",
        width,
        height,
        escape_xml(lines.front()),
        ground,
        image_width,
        plot_height,
        margin,
        plot,
        draw.take());
}

}  // namespace obscura
