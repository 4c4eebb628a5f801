// film/path_automaton.cpp - one automaton that follows paths for many light path expressions.
// SPDX-License-Identifier: Apache-2.0
#include "film/path_automaton.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

namespace obscura {

namespace {

using Kind = PathNode::Kind;

tl::unexpected<Error> refuse(std::string where, const std::string& message) {
    return fail(ExitCode::usage, "E-LPE", std::move(where), message);
}

/// A set of events of an Nfa, as bits.
using EventBits = std::vector<uint64_t>;

void insert(EventBits& set, size_t i) {
    set[i / 64] |= uint64_t{1} << (i % 64);
}

/// Calls `visit(i)` for each member.
template <typename Visit>
void for_each(const EventBits& set, const Visit& visit) {
    for (size_t i = 0; i < set.size() * 64; ++i) {
        if ((set[i / 64] >> (i % 64)) & 1) visit(i);
    }
}

/// The expressions as a graph: events, and forks that lead on without one. It is built from the end
/// of an expression to its beginning, so that each part knows what follows it.
class Nfa {
public:
    struct State {
        const PathNode* event = nullptr;  ///< nullptr: a fork, or the end
        size_t next = 0;
        size_t other = 0;       ///< of a fork
        uint64_t accepted = 0;  ///< of an end: the expression's bit
    };

    /// Adds an expression; false when all together have more than max_automaton_parts.
    bool add(const LightPathExpression& expression, size_t index) {
        nodes_ = &expression.nodes;
        const size_t end = push({.accepted = uint64_t{1} << index});
        entries_.push_back(add(expression.nodes.back(), end));
        return !is_full();
    }

    const std::vector<State>& states() const { return states_; }
    const std::vector<size_t>& entries() const { return entries_; }  ///< by expression

private:
    bool is_full() const { return states_.size() > max_automaton_parts; }

    size_t push(const State& state) {
        states_.push_back(state);
        return states_.size() - 1;
    }

    /// Adds a node that `next` follows; returns where it begins.
    size_t add(const PathNode& node, size_t next) {
        if (is_full()) return next;
        switch (node.kind) {
            case Kind::camera:
            case Kind::event:
                return push({.event = &node, .next = next});
            case Kind::repetition:
                return add_repetition(node, next);
            case Kind::sequence:
                for (size_t i = node.children.size(); i-- > 0;)
                    next = add((*nodes_)[node.children[i]], next);
                return next;
            case Kind::choice:
                break;
        }
        size_t entry = add((*nodes_)[node.children[0]], next);
        for (size_t i = 1; i < node.children.size(); ++i)
            entry = push({.next = entry, .other = add((*nodes_)[node.children[i]], next)});
        return entry;
    }

    size_t add_repetition(const PathNode& node, size_t next) {
        const PathNode& child = (*nodes_)[node.children[0]];
        size_t entry = next;
        int left = node.min_count;
        if (node.max_count == PathNode::unbounded) {
            const size_t fork = push({.other = next});
            const size_t round = add(child, fork);
            states_[fork].next = round;
            entry = node.min_count == 0 ? fork : round;
            left = std::max(node.min_count - 1, 0);
        }
        // What follows an optional round is another, or what follows the repetition.
        for (int i = node.min_count; i < node.max_count && !is_full(); ++i)
            entry = push({.next = add(child, entry), .other = next});
        for (; left > 0 && !is_full(); --left) {
            const size_t count = states_.size();
            entry = add(child, entry);
            if (states_.size() == count) break;  // it is empty, as are all further rounds
        }
        return entry;
    }

    const std::vector<PathNode>* nodes_ = nullptr;
    std::vector<State> states_;
    std::vector<size_t> entries_;
};

/// The events of an Nfa without its forks.
struct Positions {
    std::vector<const PathNode*> events;
    std::vector<EventBits> followers;  ///< by event: those that may come next
    std::vector<uint64_t> accepted;    ///< by event: the expressions that it may be the last of
    EventBits first;                   ///< those after the camera
};

/// Finds the events and ends that a state leads to through forks.
class Closure {
public:
    explicit Closure(const Nfa& nfa) : states_(nfa.states()), seen_by_(states_.size(), 0) {}

    /// Calls `visit(index, state)` for each.
    template <typename Visit>
    void visit_from(size_t entry, const Visit& visit) {
        ++visitor_;
        open_ = {entry};
        while (!open_.empty()) {
            const size_t index = open_.back();
            open_.pop_back();
            if (std::exchange(seen_by_[index], visitor_) == visitor_) continue;
            const Nfa::State& state = states_[index];
            if (state.event != nullptr || state.accepted != 0) {
                visit(index, state);
            } else {
                open_.push_back(state.next);
                open_.push_back(state.other);
            }
        }
    }

private:
    const std::vector<Nfa::State>& states_;
    std::vector<size_t> seen_by_;  ///< the last visitor of each state
    size_t visitor_ = 0;
    std::vector<size_t> open_;
};

Positions positions_of(const Nfa& nfa) {
    const std::vector<Nfa::State>& states = nfa.states();
    Positions positions;
    std::vector<size_t> position_of(states.size());
    for (size_t i = 0; i < states.size(); ++i) {
        position_of[i] = positions.events.size();
        if (states[i].event != nullptr) positions.events.push_back(states[i].event);
    }
    Closure closure(nfa);
    const EventBits empty((positions.events.size() + 63) / 64);
    for (const Nfa::State& state : states) {
        if (state.event == nullptr) continue;
        EventBits followers = empty;
        uint64_t accepted = 0;
        closure.visit_from(state.next, [&](size_t index, const Nfa::State& next) {
            accepted |= next.accepted;
            if (next.event != nullptr) insert(followers, position_of[index]);
        });
        positions.followers.push_back(std::move(followers));
        positions.accepted.push_back(accepted);
    }
    positions.first = empty;
    for (const size_t entry : nfa.entries()) {
        closure.visit_from(entry, [&](size_t index, const Nfa::State&) {
            const EventBits& after_camera = positions.followers[position_of[index]];
            for (size_t word = 0; word < empty.size(); ++word)
                positions.first[word] |= after_camera[word];
        });
    }
    return positions;
}

/// By event of the alphabet: the positions that it fits.
template <typename Event>
std::vector<EventBits> fitting(const Positions& positions, const std::vector<Event>& alphabet) {
    std::vector<EventBits> fits(alphabet.size(), EventBits(positions.first.size()));
    for (size_t a = 0; a < alphabet.size(); ++a) {
        for (size_t i = 0; i < positions.events.size(); ++i) {
            if (matches(positions.events[i]->events, alphabet[a])) insert(fits[a], i);
        }
    }
    return fits;
}

EventBits common(EventBits a, const EventBits& b) {
    for (size_t word = 0; word < a.size(); ++word)
        a[word] &= b[word];
    return a;
}

/// A deterministic automaton whose states are sets of positions.
struct Dfa {
    std::vector<std::vector<size_t>> next;        ///< by state, then scattering
    std::vector<std::vector<uint64_t>> accepted;  ///< by state, then light
};

/// Empty when it would have more than max_automaton_states.
Dfa determinize(const Positions& positions, const EventAlphabet& alphabet) {
    const std::vector<EventBits> scatterings = fitting(positions, alphabet.scatterings);
    const std::vector<EventBits> lights = fitting(positions, alphabet.lights);
    std::map<EventBits, size_t> state_of = {{positions.first, 0}};
    std::vector<EventBits> sets = {positions.first};
    Dfa dfa;
    for (size_t state = 0; state < sets.size(); ++state) {
        if (sets.size() > max_automaton_states) return {};
        dfa.next.emplace_back();
        for (const EventBits& fits : scatterings) {
            EventBits after(positions.first.size());
            for_each(common(sets[state], fits), [&](size_t i) {
                for (size_t word = 0; word < after.size(); ++word)
                    after[word] |= positions.followers[i][word];
            });
            const auto [found, is_new] = state_of.try_emplace(after, sets.size());
            if (is_new) sets.push_back(std::move(after));
            dfa.next.back().push_back(found->second);
        }
        dfa.accepted.emplace_back();
        for (const EventBits& fits : lights) {
            uint64_t accepted = 0;
            for_each(common(sets[state], fits),
                     [&](size_t i) { accepted |= positions.accepted[i]; });
            dfa.accepted.back().push_back(accepted);
        }
    }
    return dfa;
}

/// The class of each state, so that those of one class have equal futures. Classes are numbered in
/// the order of their first states.
std::vector<size_t> equal_futures(const Dfa& dfa) {
    std::map<std::vector<uint64_t>, size_t> by_lights;
    std::vector<size_t> classes;
    for (const std::vector<uint64_t>& accepted : dfa.accepted)
        classes.push_back(by_lights.try_emplace(accepted, by_lights.size()).first->second);
    size_t count = by_lights.size();
    while (true) {
        std::map<std::vector<size_t>, size_t> by_successors;
        std::vector<size_t> finer;
        for (size_t state = 0; state < classes.size(); ++state) {
            std::vector<size_t> key = {classes[state]};
            for (const size_t successor : dfa.next[state])
                key.push_back(classes[successor]);
            finer.push_back(by_successors.try_emplace(key, by_successors.size()).first->second);
        }
        if (by_successors.size() == count) return classes;
        count = by_successors.size();
        classes = std::move(finer);
    }
}

}  // namespace

Result<PathAutomaton> PathAutomaton::compile(std::span<const LightPathExpression> expressions,
                                             const EventAlphabet& alphabet) {
    if (expressions.size() > max_path_expressions) {
        return refuse("light path expressions",
                      std::to_string(expressions.size()) + " are given; at most " +
                          std::to_string(max_path_expressions) + " are accepted");
    }
    Nfa nfa;
    for (size_t i = 0; i < expressions.size(); ++i) {
        if (nfa.add(expressions[i], i)) continue;
        return refuse(expressions[i].text.substr(0, max_shown_expression),
                      "with its repetitions written out, and all expressions before it, there are"
                      " more events and branches than the accepted " +
                          std::to_string(max_automaton_parts) + "; repeat less");
    }
    const Dfa dfa = determinize(positions_of(nfa), alphabet);
    if (dfa.next.empty()) {
        return refuse("light path expressions",
                      "together they need more states than the accepted " +
                          std::to_string(max_automaton_states) + "; repeat less, or give fewer");
    }
    const std::vector<size_t> classes = equal_futures(dfa);
    PathAutomaton automaton;
    automaton.scattering_count_ = alphabet.scatterings.size();
    automaton.light_count_ = alphabet.lights.size();
    for (size_t state = 0; state < classes.size(); ++state) {
        if (classes[state] != automaton.settled_.size()) continue;  // one state stands for a class
        bool is_settled = true;
        for (const size_t successor : dfa.next[state]) {
            is_settled = is_settled && classes[successor] == classes[state];
            automaton.next_.push_back(static_cast<uint16_t>(classes[successor]));
        }
        const std::vector<uint64_t>& accepted = dfa.accepted[state];
        const bool is_black = std::count(accepted.begin(), accepted.end(), uint64_t{0}) ==
                              static_cast<std::ptrdiff_t>(accepted.size());
        automaton.accepted_.insert(automaton.accepted_.end(), accepted.begin(), accepted.end());
        automaton.settled_.push_back(is_settled);
        automaton.dead_.push_back(is_settled && is_black);
    }
    return automaton;
}

}  // namespace obscura
