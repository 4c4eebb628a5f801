// gltf/parse/node_graph.cpp - the tree of nodes: checked, and flattened to world transforms.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/node_graph.h"

#include <algorithm>
#include <cmath>

namespace obscura::gltf {

namespace {

std::string label(const Document& document, int node) {
    const std::string& name = document.nodes[static_cast<size_t>(node)].name;
    return std::to_string(node) + (name.empty() ? "" : " \"" + name + "\"");
}

std::string cycle_text(const Document& document, const std::vector<int>& parents, int inside) {
    constexpr int longest = 12;
    std::string out = label(document, inside);
    int node = parents[static_cast<size_t>(inside)];
    for (int shown = 0; node != inside && shown < longest; ++shown) {
        out = label(document, node) + " -> " + out;
        node = parents[static_cast<size_t>(node)];
    }
    if (node != inside) out = "... -> " + out;
    return label(document, inside) + " -> " + out;
}

/// Marks everything below `root`.
void mark_tree(const Document& document, int root, std::vector<char>& seen) {
    std::vector<int> open = {root};
    while (!open.empty()) {
        const int node = open.back();
        open.pop_back();
        seen[static_cast<size_t>(node)] = 1;
        const std::vector<int>& children = document.nodes[static_cast<size_t>(node)].children;
        open.insert(open.end(), children.begin(), children.end());
    }
}

/// Parent of every node, -1 for roots.
Result<std::vector<int>> find_parents(const Document& document) {
    std::vector<int> parents(document.nodes.size(), -1);
    for (size_t i = 0; i < document.nodes.size(); ++i) {
        for (const int child : document.nodes[i].children) {
            int& parent = parents[static_cast<size_t>(child)];
            if (parent >= 0) {
                return fail(ExitCode::bad_data,
                            "E-NODE-PARENTS",
                            document.at("nodes", i) + "/children",
                            "node " + label(document, child) + " has two parents, " +
                                label(document, parent) + " and " +
                                label(document, static_cast<int>(i)) +
                                "; a node must occur once in the tree");
            }
            parent = static_cast<int>(i);
        }
    }
    return parents;
}

/// The scene's roots, true roots first, so that one which is also a child is met below its parent.
std::vector<int> scene_roots(const Document& document, int scene, Log& log) {
    std::vector<char> is_child(document.nodes.size(), 0);
    for (const GltfNode& node : document.nodes) {
        for (const int child : node.children)
            is_child[static_cast<size_t>(child)] = 1;
    }
    std::vector<int> roots;
    if (scene < 0) {
        for (size_t i = 0; i < document.nodes.size(); ++i) {
            if (is_child[i] == 0) roots.push_back(static_cast<int>(i));
        }
        return roots;
    }
    roots = document.scenes[static_cast<size_t>(scene)].nodes;
    const auto is_root = [&](int node) { return is_child[static_cast<size_t>(node)] == 0; };
    const auto first_child = std::stable_partition(roots.begin(), roots.end(), is_root);
    if (first_child != roots.end()) {
        log.warn(document.at("scenes", static_cast<size_t>(scene)) + "/nodes",
                 "node " + label(document, *first_child) +
                     " is not a root node; it is drawn once, below its parent where that is drawn");
    }
    return roots;
}

/// Marks the nodes that are a coarser level of another one: the finest is drawn.
std::vector<char> lower_levels(const Document& document) {
    std::vector<char> out(document.nodes.size(), 0);
    for (size_t i = 0; i < document.nodes.size(); ++i) {
        for (const int level : document.nodes[i].lower_levels) {
            if (static_cast<size_t>(level) != i) out[static_cast<size_t>(level)] = 1;
        }
    }
    return out;
}

/// Calls visit(parent, node) for all nodes, parents first; a root's parent is -1.
template <typename Visit>
void walk_down(const Document& document, const Visit& visit) {
    const size_t count = document.nodes.size();
    std::vector<char> is_child(count, 0);
    for (const GltfNode& node : document.nodes) {
        for (const int child : node.children)
            is_child[static_cast<size_t>(child)] = 1;
    }
    std::vector<int> open;
    for (size_t i = 0; i < count; ++i) {
        if (is_child[i] != 0) continue;
        visit(-1, i);
        open.push_back(static_cast<int>(i));
    }
    while (!open.empty()) {
        const int parent = open.back();
        open.pop_back();
        for (const int child : document.nodes[static_cast<size_t>(parent)].children) {
            visit(parent, static_cast<size_t>(child));
            open.push_back(child);
        }
    }
}

std::vector<Affined> transforms(const Document& document, bool ends_at_groups) {
    std::vector<Affined> out(document.nodes.size());
    walk_down(document, [&](int parent, size_t i) {
        const GltfNode& node = document.nodes[i];
        const Affined above =
            parent < 0 ? document.world_from_root : out[static_cast<size_t>(parent)];
        out[i] = ends_at_groups && node.moves ? Affined{} : compose(above, node.parent_from_node);
    });
    return out;
}

}  // namespace

std::vector<Affined> world_transforms(const Document& document) {
    return transforms(document, false);
}

std::vector<Affined> group_transforms(const Document& document) {
    return transforms(document, true);
}

std::vector<char> moving_nodes(const Document& document) {
    std::vector<char> out(document.nodes.size(), 0);
    walk_down(document, [&](int parent, size_t i) {
        const bool above = parent >= 0 && out[static_cast<size_t>(parent)] != 0;
        out[i] = above || document.nodes[i].moves ? 1 : 0;
    });
    return out;
}

Result<void> check_node_graph(const Document& document) {
    const Result<std::vector<int>> parents = find_parents(document);
    if (!parents) return fail(parents.error());
    std::vector<char> seen(document.nodes.size(), 0);
    for (size_t i = 0; i < parents->size(); ++i) {
        if ((*parents)[i] < 0) mark_tree(document, static_cast<int>(i), seen);
    }
    const auto lost = std::find(seen.begin(), seen.end(), 0);
    if (lost == seen.end()) return {};
    // With single parents, what no root reaches hangs on a cycle: climbing ends up in it.
    int node = static_cast<int>(lost - seen.begin());
    for (size_t steps = 0; steps < parents->size(); ++steps) {
        node = (*parents)[static_cast<size_t>(node)];
    }
    return fail(ExitCode::bad_data,
                "E-NODE-CYCLE",
                document.at("nodes", static_cast<size_t>(node)),
                "the node is its own ancestor: " + cycle_text(document, *parents, node));
}

std::vector<PlacedNode> place_nodes(const Document& document, int scene, Log& log) {
    std::vector<PlacedNode> out;
    std::vector<char> seen = lower_levels(document);
    std::vector<PlacedNode> open;
    for (const int root : scene_roots(document, scene, log)) {
        open.push_back({root, document.world_from_root});
        while (!open.empty()) {
            PlacedNode next = open.back();
            open.pop_back();
            const size_t index = static_cast<size_t>(next.node);
            if (seen[index] != 0) continue;
            seen[index] = 1;
            const GltfNode& node = document.nodes[index];
            next.world_from_node = compose(next.world_from_node, node.parent_from_node);
            next.visible = next.visible && node.visible;
            next.may_show = next.may_show && (node.visible || node.moves);
            if (node.moves) next.dynamic_group = next.node;
            for (auto child = node.children.rbegin(); child != node.children.rend(); ++child) {
                open.push_back(next);
                open.back().node = *child;
            }
            out.push_back(next);
        }
    }
    return out;
}

std::string node_label(const Document& document, int node) {
    const std::string& name = document.nodes[static_cast<size_t>(node)].name;
    return name.empty() ? "node " + std::to_string(node) : name;
}

bool is_singular(const Affined& transform) {
    double lengths = 1;
    double translation = 0;
    for (int c = 0; c < 3; ++c) {
        lengths *= std::hypot(transform.m[0][c], transform.m[1][c], transform.m[2][c]);
        translation += std::abs(transform.m[c][3]);
    }
    const double volume = std::abs(determinant(transform));
    constexpr double flattest = 1e-12;  // volume of a unit parallelepiped that counts as flat
    return !std::isfinite(lengths) || !std::isfinite(translation) || !(volume > flattest * lengths);
}

bool is_flattening(const Affined& transform) {
    if (!is_singular(transform)) return false;
    constexpr double narrowest = 1e-6;  // area of a unit parallelogram that counts as a line
    const auto column = [&](int c) {
        return Vec3d{transform.m[0][c], transform.m[1][c], transform.m[2][c]};
    };
    for (int c = 0; c < 3; ++c) {
        const Vec3d a = column(c);
        const Vec3d b = column((c + 1) % 3);
        const double lengths = length(a) * length(b);
        if (std::isfinite(lengths) && length(cross(a, b)) > narrowest * lengths) return true;
    }
    return false;
}

bool is_nearly_flat(const Affined& transform) {
    constexpr double thinnest = 1e-12;
    double longest = 0;
    double shortest = INFINITY;
    for (int c = 0; c < 3; ++c) {
        const double size = length(Vec3d{transform.m[0][c], transform.m[1][c], transform.m[2][c]});
        longest = std::max(longest, size);
        shortest = std::min(shortest, size);
    }
    return shortest > 0 && shortest < thinnest * longest && std::isfinite(longest);
}

}  // namespace obscura::gltf
