// bench/report_svg.cpp - a chart of scaling by threads and instruction sets.
// SPDX-License-Identifier: Apache-2.0
#include "bench/report_svg.h"

#include "base/xml_text.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>

namespace obscura::bench {

namespace {

constexpr double panel_width = 460, panel_height = 360;
constexpr double left = 56, top = 48, bottom = 52, legend_width = 190, footer = 24;
constexpr std::array<const char*, 8> colors = {
    "#3366aa", "#cc6633", "#339966", "#aa3366", "#7755aa", "#888833", "#338899", "#666666"};

const char* color_of(size_t i) {
    return colors[i % colors.size()];
}

/// SVG elements, one a line.
class Drawing {
public:
    void text(double x, double y, const char* anchor, const std::string& words) {
        out_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n",
                            x,
                            y,
                            anchor,
                            escape_xml(words));
    }
    void title(double x, double y, const std::string& words) {
        out_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" font-weight=\"bold\">{}</text>\n",
                            x,
                            y,
                            escape_xml(words));
    }
    void line(double x0, double y0, double x1, double y1, const char* style) {
        out_ += fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n",
                            x0,
                            y0,
                            x1,
                            y1,
                            style);
    }
    void rect(double x, double y, double w, double h, const char* color) {
        out_ += fmt::format(
            "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\"/>\n",
            x,
            y,
            w,
            h,
            color);
    }
    void dot(double x, double y, const char* color) {
        out_ +=
            fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"{}\"/>\n", x, y, color);
    }
    void path(const std::string& points, const char* color) {
        out_ += fmt::format(
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"/>\n",
            points,
            color);
    }
    const std::string& elements() const { return out_; }

private:
    std::string out_;
};

constexpr const char* axis_style = "stroke=\"#333333\"";
constexpr const char* grid_style = "stroke=\"#dddddd\"";
constexpr const char* ideal_style = "stroke=\"#999999\" stroke-dasharray=\"5 4\"";

/// The plot area of one panel, in pixels, with its vertical scale from 0 to `greatest`.
struct Plot {
    double x0, y0, x1, y1;  ///< left, top, right, bottom
    double greatest;
    double y(double value) const { return y1 - (y1 - y0) * value / greatest; }
};

Plot begin_panel(Drawing& draw, size_t panel, double greatest, const std::string& title) {
    const double x = static_cast<double>(panel) * (panel_width + legend_width);
    const Plot plot = {x + left, top, x + panel_width - 16, panel_height - bottom, greatest};
    draw.title(plot.x0, 24, title);
    const double step = greatest <= 4 ? 0.5 : std::max(1.0, std::ceil(greatest / 8));
    for (double value = 0; value <= greatest; value += step) {
        draw.line(plot.x0, plot.y(value), plot.x1, plot.y(value), grid_style);
        draw.text(plot.x0 - 6, plot.y(value) + 4, "end", fmt::format("{:g}", value));
    }
    draw.line(plot.x0, plot.y0, plot.x0, plot.y1, axis_style);
    draw.line(plot.x0, plot.y1, plot.x1, plot.y1, axis_style);
    draw.text(plot.x0, plot.y0 - 8, "end", "times");
    return plot;
}

void draw_legend(Drawing& draw, const Plot& plot, const std::vector<std::string>& names) {
    for (size_t i = 0; i < names.size(); ++i) {
        const double y = plot.y0 + 18 * static_cast<double>(i);
        draw.rect(plot.x1 + 16, y, 12, 12, color_of(i));
        draw.text(plot.x1 + 34, y + 10, "start", names[i]);
    }
}

/// The entries of one scene and view.
struct Series {
    std::string name;
    std::vector<const ViewFigures*> rows;
};

std::vector<Series> series_of(const BenchReport& report,
                              std::vector<ViewFigures> SceneFigures::*rows) {
    std::vector<Series> all;
    for (const SceneFigures& scene : report.scenes) {
        for (const ViewFigures& row : scene.*rows) {
            const std::string name = scene.name + ", " + row.name;
            const auto same = [&](const Series& s) { return s.name == name; };
            auto found = std::find_if(all.begin(), all.end(), same);
            if (found == all.end()) found = all.insert(all.end(), {name, {}});
            found->rows.push_back(&row);
        }
    }
    return all;
}

std::vector<std::string> names_of(const std::vector<Series>& all) {
    std::vector<std::string> names;
    for (const Series& series : all)
        names.push_back(series.name);
    return names;
}

const ViewFigures& slowest(const Series& series) {
    return **std::max_element(
        series.rows.begin(), series.rows.end(), [](const ViewFigures* a, const ViewFigures* b) {
            return a->render_s.median < b->render_s.median;
        });
}

double greatest_speedup(const std::vector<Series>& all) {
    double greatest = 1;
    for (const Series& series : all) {
        for (const ViewFigures* row : series.rows)
            greatest = std::max(greatest, speedup_over(slowest(series), *row));
    }
    return greatest;
}

/// Speed-up over the fewest threads, by the number of threads.
void draw_scaling(Drawing& draw, size_t panel, const std::vector<Series>& all) {
    std::set<int> counts;
    for (const Series& series : all) {
        for (const ViewFigures* row : series.rows)
            counts.insert(row->threads);
    }
    const double most = *counts.rbegin();
    const double least = *counts.begin();
    const double greatest = std::max(most / least, greatest_speedup(all)) * 1.05;
    const Plot plot = begin_panel(draw, panel, greatest, "Speed-up by threads (dashed: ideal)");
    const auto x = [&](double threads) {
        return plot.x0 + (plot.x1 - plot.x0) * threads / (most * 1.05);
    };
    for (const int threads : counts)
        draw.text(x(threads), plot.y1 + 18, "middle", std::to_string(threads));
    draw.text((plot.x0 + plot.x1) / 2, plot.y1 + 38, "middle", "threads");
    draw.line(x(least), plot.y(1), x(most), plot.y(most / least), ideal_style);
    for (size_t i = 0; i < all.size(); ++i) {
        const ViewFigures& base = **std::min_element(
            all[i].rows.begin(), all[i].rows.end(), [](const auto* a, const auto* b) {
                return a->threads < b->threads;
            });
        std::string points;
        for (const ViewFigures* row : all[i].rows) {
            const double y = plot.y(speedup_over(base, *row));
            points += fmt::format("{:.1f},{:.1f} ", x(row->threads), y);
            draw.dot(x(row->threads), y, color_of(i));
        }
        draw.path(points, color_of(i));
    }
    draw_legend(draw, plot, names_of(all));
}

/// Bars of speed-up over the slowest set, grouped by set.
void draw_isas(Drawing& draw, size_t panel, const std::vector<Series>& all) {
    const Plot plot = begin_panel(
        draw, panel, greatest_speedup(all) * 1.1, "Speed-up by instruction set, over the slowest");
    const size_t sets = all.front().rows.size();
    const double group = (plot.x1 - plot.x0) / static_cast<double>(sets);
    const double bar = group * 0.8 / static_cast<double>(all.size());
    for (size_t s = 0; s < sets; ++s) {
        const double x0 = plot.x0 + group * (static_cast<double>(s) + 0.1);
        for (size_t i = 0; i < all.size(); ++i) {
            if (s >= all[i].rows.size()) continue;
            const double value = speedup_over(slowest(all[i]), *all[i].rows[s]);
            const double x = x0 + bar * static_cast<double>(i);
            draw.rect(x, plot.y(value), bar * 0.9, plot.y1 - plot.y(value), color_of(i));
        }
        draw.text(x0 + 0.4 * group, plot.y1 + 18, "middle", all.front().rows[s]->isa);
    }
    draw.text((plot.x0 + plot.x1) / 2, plot.y1 + 38, "middle", "instruction set");
    draw_legend(draw, plot, names_of(all));
}

}  // namespace

std::string bench_svg(const BenchReport& report) {
    const std::vector<Series> threads = series_of(report, &SceneFigures::by_threads);
    const std::vector<Series> isas = series_of(report, &SceneFigures::by_isa);
    Drawing draw;
    size_t panels = 0;
    if (!threads.empty()) draw_scaling(draw, panels++, threads);
    if (!isas.empty()) draw_isas(draw, panels++, isas);
    const size_t rows = std::max(threads.size(), isas.size());
    const double height = std::max(panel_height, top + 18 * static_cast<double>(rows)) + footer;
    draw.text(
        left, height - 8, "start", report.machine.cpu + ", Obscura " + report.machine.version);
    return fmt::format(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" "
        "height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} {1:.0f}\" "
        "font-family=\"sans-serif\" font-size=\"12\">\n"
        "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n{2}</svg>\n",
        static_cast<double>(std::max<size_t>(panels, 1)) * (panel_width + legend_width),
        height,
        draw.elements());
}

}  // namespace obscura::bench
