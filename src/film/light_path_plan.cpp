// film/light_path_plan.cpp - compiles the light layers of an image into the tables of the stages.
// SPDX-License-Identifier: Apache-2.0
#include "film/light_path_plan.h"

#include "base/text.h"
#include "film/light_components.h"
#include "film/path_automaton.h"
#include "surface/lobe_shares.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>

namespace obscura {

namespace {

/// The light layers, and their expressions, each once.
struct LightShares {
    struct Share {
        size_t expression;
        std::optional<size_t> group;
    };
    std::vector<Share> shares;
    std::vector<LightPathExpression> expressions;
};

LightShares shares_in(std::span<const Layer> layers) {
    LightShares out;
    for (const Layer& layer : layers) {
        const auto* share = std::get_if<LightLayer>(&layer.source);
        if (share == nullptr) continue;
        const auto found = std::find_if(
            out.expressions.begin(), out.expressions.end(), [&](const LightPathExpression& known) {
                return known.text == share->expression.text;
            });
        out.shares.push_back({static_cast<size_t>(found - out.expressions.begin()), share->group});
        if (found == out.expressions.end()) out.expressions.push_back(share->expression);
    }
    return out;
}

/// Light k of the alphabet is light class k.
EventAlphabet alphabet_of(const LightGroups& groups) {
    EventAlphabet out;
    out.scatterings.assign(scatter_events.begin(), scatter_events.end());
    for (const char kind : {'L', 'O', 'B'}) {
        for (const std::string& name : groups.names)
            out.lights.push_back({kind, groups.names.size() > 1 ? name : ""});
    }
    return out;
}

/// The labels that events have.
std::string labels_in(const EventAlphabet& alphabet) {
    std::set<std::string> labels;
    for (const ScatterEvent& event : alphabet.scatterings)
        labels.emplace(event.lobe);
    for (const LightEvent& light : alphabet.lights)
        labels.insert(light.group);
    labels.erase("");
    std::string out;
    for (const std::string& label : labels)
        out += (out.empty() ? "" : ", ") + label;
    return out;
}

/// 64 E-LPE for a label that no event has: it is mistyped, or of a group that is not asked for.
Result<void> check_labels(const LightPathExpression& expression, const EventAlphabet& alphabet) {
    const auto is_known = [&](const std::string& glob) {
        const EventSet labelled{{{"RTVLOB", "DGS-", {{glob}, false}}}};
        const auto fits = [&](const auto& event) { return matches(labelled, event); };
        return std::any_of(alphabet.scatterings.begin(), alphabet.scatterings.end(), fits) ||
               std::any_of(alphabet.lights.begin(), alphabet.lights.end(), fits);
    };
    for (const PathNode& node : expression.nodes) {
        for (const EventPattern& pattern : node.events.members) {
            const std::vector<std::string>& globs = pattern.labels.globs;
            const auto unknown = std::find_if_not(globs.begin(), globs.end(), is_known);
            if (unknown == globs.end()) continue;
            return fail(ExitCode::usage,
                        "E-LPE",
                        expression.text.substr(0, max_shown_expression),
                        "column " + std::to_string(node.column) + ": no lobe or light group fits " +
                            in_quotes(*unknown) + "; there are " + labels_in(alphabet));
        }
    }
    return {};
}

/// A component's expression, whose last event is a light, limited to a light group.
std::string labelled(const std::string& expression, const std::string& group) {
    const size_t light = expression.back() == ']' ? expression.rfind('[') : expression.size() - 1;
    return expression.substr(0, light) + "<" + expression.substr(light) + "'" + group + "'>";
}

}  // namespace

std::vector<Layer> light_group_layers(std::span<const std::string> names, bool components) {
    std::vector<Layer> out;
    for (size_t group = 0; group < names.size(); ++group) {
        const auto add = [&](const std::string& name, const char* expression) {
            Layer layer = light_layer(
                name + "_" + names[group], parse_light_path_expression(expression).value(), group);
            std::get<LightLayer>(layer.source).shown = labelled(expression, names[group]);
            out.push_back(std::move(layer));
        };
        add("light", all_light);
        if (!components) continue;
        for (const LightComponent& component : light_components())
            add(component.name, component.expression);
    }
    return out;
}

Result<LightPathPlan> LightPathPlan::make(std::span<const Layer> layers,
                                          const Scene& scene,
                                          const LightGroups& groups,
                                          std::vector<uint16_t> class_of_light) {
    const LightShares light = shares_in(layers);
    const EventAlphabet alphabet = alphabet_of(groups);
    for (const LightPathExpression& expression : light.expressions) {
        if (auto known = check_labels(expression, alphabet); !known) return fail(known.error());
    }
    const Result<PathAutomaton> automaton = PathAutomaton::compile(light.expressions, alphabet);
    if (!automaton) return fail(automaton.error());
    if (automaton->state_count() > max_path_states) {
        return fail(ExitCode::usage,
                    "E-LPE",
                    "light path expressions",
                    "together they need " + std::to_string(automaton->state_count()) +
                        " states; at most " + std::to_string(max_path_states) +
                        " are accepted; give fewer, or ones that tell fewer paths apart");
    }
    LightPathPlan out;
    out.group_count_ = static_cast<uint32_t>(groups.names.size());
    out.environment_group_ = groups.environment;
    out.class_of_light_ = std::move(class_of_light);
    out.find_class_runs();
    out.layer_count_ = static_cast<int>(light.shares.size());
    out.shadow_ = std::any_of(layers.begin(), layers.end(), [](const Layer& layer) {
        return std::holds_alternative<ShadowRatio>(layer.source);
    });
    out.layer_begin_.push_back(0);
    const auto states = static_cast<uint16_t>(automaton->state_count());  // max_path_states at most
    for (uint16_t state = 0; state < states; ++state) {
        out.settled_.push_back(automaton->is_settled(state) ? 1 : 0);
        for (size_t event = 0; event < scatter_event_count; ++event)
            out.next_.push_back(automaton->after_scattering(state, event));
        for (size_t light_class = 0; light_class < light_kinds * groups.names.size();
             ++light_class) {
            const uint64_t accepted = automaton->accepted(state, light_class);
            for (size_t k = 0; k < light.shares.size(); ++k) {
                const auto& [expression, group] = light.shares[k];
                if ((accepted >> expression & 1U) == 0) continue;
                if (group && *group != light_class % groups.names.size()) continue;
                out.layers_.push_back(static_cast<uint16_t>(k));
            }
            out.layer_begin_.push_back(static_cast<uint32_t>(out.layers_.size()));
        }
    }
    out.find_common_states();
    out.number_sums();
    out.group_emitters(scene, groups);
    return out;
}

void LightPathPlan::find_class_runs() {
    class_runs_.push_back({0, 0});
    for (size_t light = 0; light < class_of_light_.size(); ++light) {
        const LightClassRun run{static_cast<int32_t>(light), class_of_light_[light]};
        if (light == 0) {
            class_runs_.front() = run;
        } else if (run.light_class != class_runs_.back().light_class) {
            class_runs_.push_back(run);
        }
    }
}

void LightPathPlan::find_common_states() {
    for (size_t state = 0; state < settled_.size(); ++state) {
        const uint16_t* next = &next_[state * scatter_event_count];
        const bool common =
            std::all_of(next, next + straight_event, [&](uint16_t one) { return one == *next; });
        common_next_.push_back(common && settled_[*next] != 0 ? *next : no_common_state);
    }
}

/// Classes that belong to the same layers in every state that counts share a sum.
///
/// In      counts: whether light may rest in a state
template <typename Counts>
LightPathPlan::Sums LightPathPlan::sums_for(const Counts& counts) const {
    const size_t classes = size_t{light_kinds} * group_count_;
    std::map<std::vector<std::vector<uint16_t>>, uint16_t> known;
    Sums out;
    for (size_t light_class = 0; light_class < classes; ++light_class) {
        std::vector<std::vector<uint16_t>> key;
        bool is_shown = false;
        for (size_t state = 0; state < settled_.size(); ++state) {
            if (!counts(state)) continue;
            const size_t row = state * classes + light_class;
            key.emplace_back(layers_.begin() + layer_begin_[row],
                             layers_.begin() + layer_begin_[row + 1]);
            is_shown |= !key.back().empty();
        }
        uint16_t sum = no_light_sum;
        if (is_shown) {
            const auto next = static_cast<uint16_t>(out.classes.size());
            const auto [found, is_new] = known.try_emplace(std::move(key), next);
            sum = found->second;
            if (is_new) out.classes.push_back(static_cast<uint16_t>(light_class));
        }
        out.of_class.push_back(sum);
    }
    return out;
}

/// Weights rest in settled states, and in those to which scatterings lead. Sharing out takes a step
/// for each sum and state, whether light has arrived or not: many resting sums would not pay.
void LightPathPlan::number_sums() {
    constexpr size_t max_resting_sums = 8;
    settled_sums_ = sums_for([&](size_t state) { return settled_[state] != 0; });
    resting_sums_ = sums_for(
        [&](size_t state) { return std::find(next_.begin(), next_.end(), state) != next_.end(); });
    if (resting_sums_.classes.size() <= max_resting_sums) return;
    resting_sums_.classes.clear();
    std::fill(resting_sums_.of_class.begin(), resting_sums_.of_class.end(), no_light_sum);
}

void LightPathPlan::group_emitters(const Scene& scene, const LightGroups& groups) {
    const auto group_of_node = [&](int32_t node) {
        const auto index = static_cast<size_t>(node);
        return node >= 0 && index < groups.of_node.size() ? groups.of_node[index] : groups.rest();
    };
    for (const Primitive& primitive : scene.primitives) {
        const uint16_t own = groups.of_material[static_cast<size_t>(primitive.material)];
        group_of_primitive_.push_back(std::min(own, group_of_node(primitive.node)));
    }
    for (const Instance& instance : scene.instances)
        group_of_instance_.push_back(group_of_node(instance.node));
}

LightPathTable LightPathPlan::table() const {
    return {.next = next_.data(),
            .settled = settled_.data(),
            .common_next = common_next_.data(),
            .state_count = static_cast<int>(settled_.size()),
            .layer_begin = layer_begin_.data(),
            .layers = layers_.data(),
            .layer_count = layer_count_,
            .sum_of_class = settled_sums_.of_class.data(),
            .class_of_sum = settled_sums_.classes.data(),
            .sum_count = static_cast<int>(settled_sums_.classes.size()),
            .resting_sum_of_class = resting_sums_.of_class.data(),
            .class_of_resting_sum = resting_sums_.classes.data(),
            .resting_sum_count = static_cast<int>(resting_sums_.classes.size()),
            .group_count = group_count_,
            .class_count = light_kinds * group_count_,
            .environment_group = environment_group_,
            .class_of_light = class_of_light_.data(),
            .class_runs = class_runs_.data(),
            .class_run_count = static_cast<int>(class_runs_.size()),
            .group_of_primitive = group_of_primitive_.data(),
            .group_of_instance = group_of_instance_.data(),
            .shadow = shadow_};
}

}  // namespace obscura
