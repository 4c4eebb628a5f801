// tools/make_albedo_tables.cpp - integrates the lobes of src/surface into tables, as C++ source.
// SPDX-License-Identifier: Apache-2.0
// Usage: make_albedo_tables FILE. Run by the build. Means over a regular grid of visible normals
// (Dupuy and Benyoub, 2023), for which what a facet reflects weighs Fresnel * smith_shadowing.
#include "surface/glass_albedo.h"
#include "surface/sheen.h"
#include "surface/stretched_albedo.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

namespace obscura {
namespace {

constexpr double min_alpha = 1e-5;
constexpr double min_cosine = 1e-4;

/// Lobes are divided by these shares, so an interpolated share that is too low would create light.
/// The tables are raised by as much as interpolation is too low at all but one in a hundred points.
constexpr double specular_headroom = 1.0012;
constexpr double stretched_headroom = 1.0025;
constexpr double glass_headroom = 1.001;

double raised(double share, double headroom) {
    return std::fmin(share * headroom, 1.0);
}

double share(int step, int steps) {
    return static_cast<double>(step) / (steps - 1);
}

double cosine_at(int step, int steps) {
    return std::fmax(square(share(step, steps)), min_cosine);
}

double alpha_at(int step, int steps) {
    return std::fmax(square(share(step, steps)), min_alpha);
}

/// Steps of a mean over visible normals: around the view direction and along it.
struct Grid {
    int turns, heights;
    double circle = 1;  ///< 0.5: half of it, for surfaces that look alike on both sides of wo
};

/// Calls use(h, dot(wo, h)) for the grid's visible normals.
template <typename Use>
void for_facets(const Vec3d& wo, const GgxWidths<double>& alpha, const Grid& grid, const Use& use) {
    for (int i = 0; i < grid.turns; ++i) {
        const SinCos<double> turn = sin_cos_turn(grid.circle * (i + 0.5) / grid.turns);
        for (int j = 0; j < grid.heights; ++j) {
            const Vec3d h = visible_normal(wo, alpha, turn, (j + 0.5) / grid.heights);
            use(h, dot(wo, h));
        }
    }
}

double shadowing(const Vec3d& wo, const Vec3d& wi, const GgxWidths<double>& alpha) {
    return smith_shadowing(wo.z, smith_length(wo, alpha), std::fabs(wi.z), smith_length(wi, alpha));
}

SpecularAlbedo<double> reflected(const Vec3d& wo,
                                 const GgxWidths<double>& alpha,
                                 const Grid& grid) {
    SpecularAlbedo<double> sum{0, 0};
    for_facets(wo, alpha, grid, [&](const Vec3d& h, double cosine) {
        const Vec3d wi = h * (2 * cosine) - wo;
        if (!(wi.z > 0)) return;
        const double left = shadowing(wo, wi, alpha);
        sum.mirror += left;
        sum.grazing += left * schlick_weight(cosine);
    });
    const double scale = 1.0 / (grid.turns * grid.heights);
    return {sum.mirror * scale, sum.grazing * scale};
}

/// What a rough boundary reflects and refracts, its facets reflecting totally or not at all, and
/// following Schlick.
struct GlassShares {
    double total, schlick;
};

GlassShares through_glass(double cosine, double width, double eta, const Grid& grid) {
    const Vec3d wo{std::sqrt(1 - cosine * cosine), 0, cosine};
    const GgxWidths<double> alpha{width, width};
    const double f0 = normal_reflectance(eta);
    const double f90 = grazing_reflectance(eta);
    GlassShares sum{0, 0};
    for_facets(wo, alpha, grid, [&](const Vec3d& h, double cos_h) {
        const double beyond = refracted_cosine(cos_h, eta);
        const bool is_total = beyond < 0;
        const Vec3d mirrored = h * (2 * cos_h) - wo;
        const double back = mirrored.z > 0 ? shadowing(wo, mirrored, alpha) : 0;
        const Vec3d refracted = h * (cos_h / eta - beyond) - wo * (1 / eta);
        const double on = !is_total && refracted.z < 0 ? shadowing(wo, refracted, alpha) : 0;
        const double weight = schlick_weight(eta < 1 ? beyond : cos_h);
        const double reflectance = is_total ? 1 : f0 + (f90 - f0) * weight;
        sum.total += is_total ? back : on;
        sum.schlick += reflectance * back + (1 - reflectance) * on;
    });
    const double scale = 1.0 / (grid.turns * grid.heights);
    return {sum.total * scale, sum.schlick * scale};
}

/// Integral over directions, finer towards the horizon, where narrow fibres shine.
double sheen(double cosine, double roughness) {
    constexpr int grid = 96;
    const double alpha = std::fmax(roughness * roughness, static_cast<double>(min_sheen_alpha));
    const double sine = std::sqrt(1 - cosine * cosine);
    double sum = 0;
    for (int i = 0; i < grid; ++i) {
        const double cos_i = square((i + 0.5) / grid);
        const double sin_i = std::sqrt(1 - cos_i * cos_i);
        const double width = square((i + 1.0) / grid) - square(1.0 * i / grid);
        for (int j = 0; j < grid; ++j) {
            const double turn = pi_d * (j + 0.5) / grid;
            const Vec3d h = normalize(
                Vec3d{sine + sin_i * std::cos(turn), sin_i * std::sin(turn), cosine + cos_i});
            sum += charlie_cos(cosine, cos_i, h.z, alpha) * width * 2 * pi_d / grid;
        }
    }
    return sum;
}

/// Nodes of the tables over cosine and roughness.
template <typename Value>
auto plain_nodes(const Value& value) {
    std::vector<decltype(value(1.0, 0.0))> nodes;
    for (int r = 0; r < albedo_roughnesses; ++r) {
        for (int c = 0; c < albedo_cosines; ++c)
            nodes.push_back(value(cosine_at(c, albedo_cosines), share(r, albedo_roughnesses)));
    }
    return nodes;
}

/// Cells of those tables: for each of `values` numbers of a node the four corners.
template <typename Node, typename Number>
std::vector<double> plain_cells(const std::vector<Node>& nodes, int values, const Number& number) {
    std::vector<double> cells;
    for (int i = 0; i < albedo_cells; ++i) {
        const int next = i % albedo_cosines < albedo_cosines - 1 ? 1 : 0;
        for (int value = 0; value < values; ++value) {
            for (const int corner : {i, i + next, i + albedo_cosines, i + albedo_cosines + next})
                cells.push_back(number(nodes[static_cast<size_t>(corner)], value));
        }
    }
    return cells;
}

/// Cells of tables whose last step is the cosine: two numbers of a node, and of the next cosine's.
std::vector<double> pair_cells(const std::vector<std::array<double, 2>>& nodes, size_t cosines) {
    std::vector<double> cells;
    for (size_t i = 0; i < nodes.size(); ++i) {
        const size_t next = i % cosines < cosines - 1 ? i + 1 : i;
        cells.insert(cells.end(), nodes[i].begin(), nodes[i].end());
        cells.insert(cells.end(), nodes[next].begin(), nodes[next].end());
    }
    return cells;
}

std::vector<double> specular_table() {
    constexpr Grid grid{32, 256, 0.5};
    const auto nodes = plain_nodes([&](double cosine, double roughness) {
        const double alpha = std::fmax(roughness * roughness, min_alpha);
        return reflected({std::sqrt(1 - cosine * cosine), 0, cosine}, {alpha, alpha}, grid);
    });
    return plain_cells(nodes, 2, [](const SpecularAlbedo<double>& node, int value) {
        return value == 0 ? raised(node.mirror, specular_headroom) : node.grazing;
    });
}

std::vector<double> stretched_table() {
    constexpr Grid grid{48, 64};
    std::vector<std::array<double, 2>> nodes;
    for (int i = 0; i < stretched_nodes; ++i) {
        const int c = i % stretched_cosines;
        const int turn = i / stretched_cosines % stretched_turns;
        const int r = i / stretched_cosines / stretched_turns % stretched_roughnesses;
        const int ratio = i / stretched_cosines / stretched_turns / stretched_roughnesses;
        const double narrow = alpha_at(r, stretched_roughnesses);
        // The least ratio stands for the limit; there the turn makes no difference.
        const double wider = std::fmax(square(share(ratio, stretched_ratios)), 1e-6);
        const double wide = narrow + wider * (1 - narrow);
        const double along = narrow + share(turn, stretched_turns) * (wide - narrow);
        const double cos2 =
            wide > narrow ? (square(along) - square(narrow)) / (square(wide) - square(narrow)) : 1;
        const double cosine = cosine_at(c, stretched_cosines);
        const double sine = std::sqrt(1 - cosine * cosine);
        const Vec3d wo{sine * std::sqrt(cos2), sine * std::sqrt(std::fmax(1 - cos2, 0.0)), cosine};
        const SpecularAlbedo<double> node = reflected(wo, {wide, narrow}, grid);
        nodes.push_back({raised(node.mirror, stretched_headroom), node.grazing});
    }
    return pair_cells(nodes, stretched_cosines);
}

std::vector<double> glass_table() {
    std::vector<std::array<double, 2>> nodes;
    for (int i = 0; i < glass_nodes; ++i) {
        const int c = i % glass_cosines;
        const int r = i / glass_cosines % glass_roughnesses;
        const int index = i / glass_cosines / glass_roughnesses % glass_indices;
        const bool from_denser = i / glass_cosines / glass_roughnesses / glass_indices == 1;
        // Equal indices stand for the limit: formulas need some difference.
        const double root = std::fmax(
            square(share(index, glass_indices)) * static_cast<double>(glass_last_root), 5e-4);
        const double eta = (1 + root) / (1 - root);
        const GlassShares node = through_glass(cosine_at(c, glass_cosines),
                                               alpha_at(r, glass_roughnesses),
                                               from_denser ? 1 / eta : eta,
                                               {24, 224, 0.5});
        nodes.push_back({raised(node.total, glass_headroom), raised(node.schlick, glass_headroom)});
    }
    return pair_cells(nodes, glass_cosines);
}

void write(std::FILE* file, const char* name, const std::vector<double>& numbers) {
    std::fprintf(file, "const float %s[%zu] = {", name, numbers.size());
    for (size_t i = 0; i < numbers.size(); ++i)
        std::fprintf(file, "%s%.7ff,", i % 8 == 0 ? "\n    " : " ", numbers[i]);
    std::fprintf(file, "\n};\n");
}

}  // namespace
}  // namespace obscura

int main(int count, char** arguments) {
    using namespace obscura;
    std::FILE* file = count == 2 ? std::fopen(arguments[1], "w") : nullptr;
    if (file == nullptr) {
        std::fprintf(stderr, "usage: make_albedo_tables FILE, which can be written\n");
        return 1;
    }
    std::fprintf(file,
                 "#include \"surface/glass_albedo.h\"\n#include \"surface/stretched_albedo.h\"\n\n"
                 "namespace obscura {\n");
    write(file, "specular_cells", specular_table());
    write(file, "sheen_cells", plain_cells(plain_nodes(sheen), 1, [](double node, int /*value*/) {
              return node;
          }));
    write(file, "stretched_cells", stretched_table());
    write(file, "glass_cells", glass_table());
    std::fprintf(file, "}  // namespace obscura\n");
    return std::fclose(file) == 0 ? 0 : 1;
}
