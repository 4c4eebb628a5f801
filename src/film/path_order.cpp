// film/path_order.cpp - checks that paths begin with the camera and end with a light.
// SPDX-License-Identifier: Apache-2.0
#include "film/path_order.h"

#include <algorithm>
#include <array>

namespace obscura {

namespace {

using Kind = PathNode::Kind;

/// How far a path may have come, as a set of bits.
using Progress = unsigned;
constexpr Progress none = 0;
constexpr Progress before_camera = 1;
constexpr Progress under_way = 2;  ///< behind the camera and any number of scatterings
constexpr Progress after_light = 4;

constexpr size_t stage_count = 3;

/// From each of the three, as bit 0, 1 and 2, where a node's events lead.
using Steps = std::array<Progress, stage_count>;

Progress step(const Steps& steps, Progress from) {
    Progress to = none;
    for (size_t i = 0; i < stage_count; ++i) {
        if (from & (1u << i)) to |= steps[i];
    }
    return to;
}

/// True when the pattern accepts the type and mode, whatever the label.
bool covers(const EventPattern& pattern, char type, char mode) {
    return pattern.types.find(type) != std::string::npos &&
           pattern.modes.find(mode) != std::string::npos;
}

/// True when some event of this type and mode is in the set.
bool can_be(const EventSet& events, char type, char mode) {
    const auto& members = events.members;
    if (!events.negated) {
        return std::any_of(members.begin(), members.end(), [&](const EventPattern& pattern) {
            return covers(pattern, type, mode);
        });
    }
    return std::none_of(members.begin(), members.end(), [&](const EventPattern& pattern) {
        const bool any_label = pattern.labels.negated && pattern.labels.globs.empty();
        return any_label && covers(pattern, type, mode);
    });
}

/// Where one event leads that comes after the camera.
Progress after_event(const EventSet& events) {
    Progress to = none;
    for (const char type : {'R', 'T', 'V'}) {
        for (const char mode : {'D', 'G', 'S'})
            to |= can_be(events, type, mode) ? under_way : none;
    }
    for (const char kind : {'L', 'O', 'B'})
        to |= can_be(events, kind, no_mode) ? after_light : none;
    return to;
}

/// The order of events in one expression: where each node leads, and where it is begun.
class PathOrder {
public:
    explicit PathOrder(const std::vector<PathNode>& nodes)
        : nodes_(nodes), steps_(nodes.size()), begun_(nodes.size(), none) {
        for (size_t i = 0; i < nodes.size(); ++i) {
            for (size_t k = 0; k < stage_count; ++k)
                steps_[i][k] = leads_to(nodes[i], 1u << k);
        }
        begun_.back() = before_camera;
        for (size_t i = nodes.size(); i-- > 0;)
            begin_children(nodes[i], begun_[i]);
    }

    std::optional<PathOrderFault> fault() const {
        for (size_t i = 0; i < nodes_.size(); ++i) {
            const std::string message = fault_of(nodes_[i], begun_[i]);
            if (!message.empty()) return PathOrderFault{nodes_[i].column, message};
        }
        const Progress end = step(steps_.back(), before_camera);
        if (end & ~after_light) {
            return PathOrderFault{
                0, "it accepts paths that do not end with a light; end it with L, O, B or [LOB]"};
        }
        if (end == none) return PathOrderFault{0, "no path fits it: nothing follows a light"};
        return {};
    }

private:
    /// Calls `visit(from)` before each round of a repetition; returns where all of it leads. No
    /// more than stage_count rounds beyond the fewest bring anything new.
    template <typename Visit>
    Progress repeat(const PathNode& node, Progress from, const Visit& visit) const {
        const int useful = node.min_count + static_cast<int>(stage_count);
        const int rounds = node.max_count == PathNode::unbounded ? useful : node.max_count;
        Progress to = node.min_count == 0 ? from : none;
        for (int round = 1; round <= std::min(rounds, useful); ++round) {
            visit(from);
            from = step(steps_[node.children[0]], from);
            if (round >= node.min_count) to |= from;
        }
        return to;
    }

    Progress leads_to(const PathNode& node, Progress from) const {
        switch (node.kind) {
            case Kind::camera:
                return from == before_camera ? under_way : none;
            case Kind::event:
                return from == under_way ? after_event(node.events) : none;
            case Kind::repetition:
                return repeat(node, from, [](Progress) {});
            case Kind::sequence:
                for (const size_t child : node.children)
                    from = step(steps_[child], from);
                return from;
            case Kind::choice:
                break;
        }
        Progress to = none;
        for (const size_t child : node.children)
            to |= step(steps_[child], from);
        return to;
    }

    void begin_children(const PathNode& node, Progress from) {
        if (node.kind == Kind::repetition) {
            repeat(node, from, [&](Progress round) { begun_[node.children[0]] |= round; });
            return;
        }
        for (const size_t child : node.children) {
            begun_[child] |= from;
            if (node.kind == Kind::sequence) from = step(steps_[child], from);
        }
    }

    static std::string fault_of(const PathNode& node, Progress begun) {
        if (node.kind == Kind::camera) {
            return begun & ~before_camera ? "C is accepted as the first event only" : "";
        }
        if (node.kind != Kind::event) return "";
        if (begun & before_camera) {
            return "a path begins with the camera: C is accepted here; an alternative within a path"
                   " has parentheses around it, as in C(D|SD)L";
        }
        if (after_event(node.events) == none) return "no event fits this";
        return begun == after_light ? "nothing follows a light: the end is accepted here" : "";
    }

    const std::vector<PathNode>& nodes_;
    std::vector<Steps> steps_;     ///< by node
    std::vector<Progress> begun_;  ///< by node
};

}  // namespace

std::optional<PathOrderFault> find_path_order_fault(const std::vector<PathNode>& nodes) {
    return PathOrder(nodes).fault();
}

}  // namespace obscura
