// tests/film/path_automaton_test.cpp - the automaton against two other matchers, and its size.
// SPDX-License-Identifier: Apache-2.0
#include "film/path_automaton.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <random>
#include <regex>
#include <stdexcept>

namespace obscura {
namespace {

/// Named a to e and L, K, O, B in regular expressions.
const EventAlphabet small_alphabet = {{{'R', 'D', "diffuse"},
                                       {'R', 'G', "specular"},
                                       {'R', 'S', "coat"},
                                       {'T', 'S', "transmission"},
                                       {'V', 'D', "volume"}},
                                      {{'L', ""}, {'L', "key"}, {'O', ""}, {'B', ""}}};
constexpr std::string_view scattering_names = "abcde";
constexpr std::string_view light_names = "LKOB";

/// Named a to i; the lights are L, O and B.
const EventAlphabet surface_alphabet = {{{'R', 'D', "diffuse"},
                                         {'R', 'G', "specular"},
                                         {'R', 'S', "specular"},
                                         {'R', 'G', "coat"},
                                         {'R', 'G', "sheen"},
                                         {'T', 'G', "transmission"},
                                         {'T', 'S', "transmission"},
                                         {'T', 'D', "diffuse_transmission"},
                                         {'V', 'D', "volume"}},
                                        {{'L', ""}, {'O', ""}, {'B', ""}}};

std::vector<LightPathExpression> parsed(const std::vector<std::string>& texts) {
    std::vector<LightPathExpression> expressions;
    for (const std::string& text : texts) {
        auto expression = parse_light_path_expression(text);
        if (!expression) {
            ADD_FAILURE() << text << ": " << expression.error().message;
            continue;
        }
        expressions.push_back(std::move(*expression));
    }
    return expressions;
}

PathAutomaton compiled(const std::vector<std::string>& texts, const EventAlphabet& alphabet) {
    auto automaton = PathAutomaton::compile(parsed(texts), alphabet);
    if (!automaton) throw std::runtime_error(automaton.error().message);
    return std::move(*automaton);
}

int state_count(const std::vector<std::string>& texts,
                const EventAlphabet& alphabet = surface_alphabet) {
    return compiled(texts, alphabet).state_count();
}

/// A path after the camera: indices of scatterings, and its state.
struct Prefix {
    std::vector<size_t> scatterings;
    uint16_t state = 0;
};

/// Calls `visit` for each sequence of at most `length` scatterings.
void for_each_prefix(const PathAutomaton& automaton,
                     size_t scattering_count,
                     size_t length,
                     const std::function<void(const Prefix&)>& visit) {
    std::vector<Prefix> prefixes = {{{}, automaton.start()}};
    for (size_t i = 0; i < prefixes.size(); ++i) {
        visit(prefixes[i]);
        if (prefixes[i].scatterings.size() == length) continue;
        for (size_t s = 0; s < scattering_count; ++s) {
            Prefix longer = prefixes[i];
            longer.scatterings.push_back(s);
            longer.state = automaton.after_scattering(longer.state, s);
            prefixes.push_back(std::move(longer));
        }
    }
}

struct Translated {
    const char* expression;
    const char* regex;  ///< the same by hand, over the names of small_alphabet's events
};

constexpr Translated translated[] = {
    {"CO", "O"},
    {"C.*[LOB]", "[a-e]*[LKOB]"},
    {"C.L", "[a-e][LK]"},
    {"C.+O", "[a-e]+O"},
    {"CDL", "[ae][LK]"},
    {"C<RD>[LO]", "a[LKO]"},
    {"C<.[GS]>+D*L", "[bcd]+[ae]*[LK]"},
    {"C[SG]*D*<L.'key'>", "[bcd]*[ae]*K"},
    {"C[SG]*D{2,3}L", "[bcd]*[ae]{2,3}[LK]"},
    {"C<R[^D]>+D*L", "[bc]+[ae]*[LK]"},
    {"C([SG]*D){1,2}L", "([bcd]*[ae]){1,2}[LK]"},
    {"C[^S]*B", "[abe]*B"},
    {"C(D|SD)L", "([ae]|[cd][ae])[LK]"},
    {"(CDL)|(CSO)", "[ae][LK]|[cd]O"},
    {"CD{2}L", "[ae][ae][LK]"},
    {"CD{2,}[OB]", "[ae][ae]+[OB]"},
    {"CD{0,2}<O>", "[ae]?[ae]?O"},
    {"CD?S?G?L", "[ae]?[cd]?b?[LK]"},
    {"C(DS)*L", "([ae][cd])*[LK]"},
    {"C(D*S*)*B", "[acde]*B"},
    {"C((D?)*S?)+B", "[acde]*B"},
    {"C(R+|T+)<L'k*y'>", "(([abc]+)|d+)K"},
    {"C<R.'coat'>.*[LOB]", "c[a-e]*[LKOB]"},
    {"C<..[^'coat']>{1,2}B", "[abde]{1,2}B"},
    {"C[^<R.['diffuse' 'coat']>LOB]+L", "[bde]+[LK]"},
    {"CV.{2}[^L]?O", "e[a-e]{2,3}O"},
    {"C.*<TS>.*<L[^'key']>", "[a-e]*d[a-e]*L"},
    {"C.?.?B", "[a-e]{0,2}B"},
    {"C[DL]O|C[DL]B", "[ae][OB]"},
    {"C(L|D(L|S(O|T*B)))", "[LK]|[ae]([LK]|[cd](O|d*B))"},
    {"C<R.'glass'>L", "(?!)"},
    {"C(D{0}|S{1}){3}L", "[cd]{0,3}[LK]"},
    {"CD+S+D+[LOB]", "[ae]+[cd]+[ae]+[LKOB]"},
};

TEST(PathAutomaton, AcceptsWhatRegularExpressionsWrittenByHandAccept) {
    std::vector<std::string> texts;
    std::vector<std::regex> regexes;
    for (const Translated& pair : translated) {
        texts.emplace_back(pair.expression);
        regexes.emplace_back(pair.regex);
    }
    const PathAutomaton automaton = compiled(texts, small_alphabet);
    for_each_prefix(automaton, scattering_names.size(), 4, [&](const Prefix& prefix) {
        std::string path;
        for (const size_t s : prefix.scatterings)
            path += scattering_names[s];
        for (size_t light = 0; light < light_names.size(); ++light) {
            const std::string whole = path + light_names[light];
            const uint64_t accepted = automaton.accepted(prefix.state, light);
            for (size_t i = 0; i < texts.size(); ++i) {
                const bool expected = std::regex_match(whole, regexes[i]);
                ASSERT_EQ(((accepted >> i) & 1) != 0, expected) << texts[i] << " with " << whole;
            }
        }
    });
}

/// An expression of random operators and events, each path of which ends with a light.
class RandomExpression {
public:
    explicit RandomExpression(unsigned seed) : random_(seed) {}

    std::string text() {
        const std::string scatterings = part(3);
        return "C" + scatterings + one_of({"L", "[LO]", "[^<L'key'>RTV]"});
    }

private:
    size_t below(size_t count) { return random_() % count; }

    std::string one_of(const std::vector<std::string>& choices) {
        return choices[below(choices.size())];
    }

    std::string part(int depth) {
        if (depth == 0) {
            return one_of({"D", "S", "<RG>", "R", "[^S]", ".", "T", "<R.'coat'>", "[VG]", "[^D]"});
        }
        const size_t kind = below(4);
        const std::string first = part(depth - 1);
        if (kind == 0) return first + part(depth - 1);
        if (kind == 1) return "(" + first + "|" + part(depth - 1) + ")";
        if (kind == 2) return first;
        return "(" + first + ")" + one_of({"*", "+", "?", "{2}", "{1,3}", "{2,}", "{0}"});
    }

    std::mt19937 random_;
};

/// A matcher on the tree: where a part of a path may end that begins at one of some positions.
class TreeMatcher {
public:
    TreeMatcher(const LightPathExpression& expression, const Prefix& prefix, size_t light)
        : expression_(expression), prefix_(prefix), light_(light) {}

    /// Positions count the camera, the scatterings and the light.
    bool accepts() const {
        const size_t length = prefix_.scatterings.size() + 2;
        return (ends(expression_.nodes.back(), 1) >> length) & 1;
    }

private:
    bool fits(const PathNode& node, size_t position) const {
        if (node.kind == PathNode::Kind::camera) return position == 0;
        const size_t count = prefix_.scatterings.size();
        if (position == 0 || position > count + 1) return false;
        if (position == count + 1) return matches(node.events, small_alphabet.lights[light_]);
        const size_t scattering = prefix_.scatterings[position - 1];
        return matches(node.events, small_alphabet.scatterings[scattering]);
    }

    /// In      begins: positions as bits
    unsigned ends(const PathNode& node, unsigned begins) const {
        unsigned found = 0;
        switch (node.kind) {
            case PathNode::Kind::sequence:
                for (const size_t child : node.children)
                    begins = ends(expression_.nodes[child], begins);
                return begins;
            case PathNode::Kind::choice:
                for (const size_t child : node.children)
                    found |= ends(expression_.nodes[child], begins);
                return found;
            case PathNode::Kind::repetition:
                for (int i = 0; i <= (node.max_count < 0 ? 20 : node.max_count); ++i) {
                    if (i >= node.min_count) found |= begins;
                    begins = ends(expression_.nodes[node.children[0]], begins);
                }
                return found;
            default:
                break;
        }
        for (size_t position = 0; position < 16; ++position) {
            if (((begins >> position) & 1) && fits(node, position)) found |= 2u << position;
        }
        return found;
    }

    const LightPathExpression& expression_;
    const Prefix& prefix_;
    size_t light_;
};

TEST(PathAutomaton, AcceptsWhatAMatcherOnTheTreeAccepts) {
    RandomExpression random(7);
    for (int batch = 0; batch < 40; ++batch) {
        std::vector<std::string> texts;
        for (int i = 0; i < 4; ++i)
            texts.push_back(random.text());
        const std::vector<LightPathExpression> expressions = parsed(texts);
        ASSERT_EQ(expressions.size(), texts.size());
        const auto automaton = PathAutomaton::compile(expressions, small_alphabet);
        ASSERT_TRUE(automaton) << automaton.error().message;
        for_each_prefix(*automaton, scattering_names.size(), 3, [&](const Prefix& prefix) {
            for (size_t light = 0; light < light_names.size(); ++light) {
                const uint64_t accepted = automaton->accepted(prefix.state, light);
                for (size_t i = 0; i < expressions.size(); ++i) {
                    const bool expected = TreeMatcher(expressions[i], prefix, light).accepts();
                    ASSERT_EQ(((accepted >> i) & 1) != 0, expected) << texts[i];
                }
            }
        });
    }
}

/// Layers that divide all light among them, by the first scattering.
constexpr const char* partition[] = {"CO",
                                     "CB",
                                     "CL",
                                     "C<RD'diffuse'>[LOB]",
                                     "C<RD'diffuse'>.+[LOB]",
                                     "C<R[GS]'specular'>[LOB]",
                                     "C<R[GS]'specular'>.+[LOB]",
                                     "C<R.'coat'>[LOB]",
                                     "C<R.'coat'>.+[LOB]",
                                     "C<R.'sheen'>[LOB]",
                                     "C<R.'sheen'>.+[LOB]",
                                     "C<T[GS]>[LOB]",
                                     "C<T[GS]>.+[LOB]",
                                     "C<TD>.*[LOB]",
                                     "CV.*[LOB]"};

/// The layer that a path belongs to.
size_t layer_of(const std::vector<size_t>& scatterings, size_t light) {
    constexpr std::array<size_t, 3> seen_directly = {2, 0, 1};  // L, O, B
    constexpr std::array<size_t, 9> direct = {3, 5, 5, 7, 9, 11, 11, 13, 14};
    if (scatterings.empty()) return seen_directly[light];
    const size_t layer = direct[scatterings[0]];
    return layer + (layer < 13 && scatterings.size() > 1 ? 1 : 0);
}

TEST(PathAutomaton, ThePartitionAcceptsEachPathOnce) {
    const std::vector<std::string> texts(std::begin(partition), std::end(partition));
    const PathAutomaton automaton = compiled(texts, surface_alphabet);
    size_t paths = 0;
    for_each_prefix(automaton, 9, 5, [&](const Prefix& prefix) {
        for (size_t light = 0; light < 3; ++light) {
            const uint64_t expected = uint64_t{1} << layer_of(prefix.scatterings, light);
            ASSERT_EQ(automaton.accepted(prefix.state, light), expected);
            ++paths;
        }
    });
    EXPECT_EQ(paths, 3u * (1 + 9 + 81 + 729 + 6561 + 59049));
}

TEST(PathAutomaton, HasAsManyStatesAsCountedByHand) {
    const std::vector<std::string> texts(std::begin(partition), std::end(partition));
    // The start; direct and indirect of diffuse, specular, coat, sheen and transmission; one each
    // of subsurface and volume. No path is lost, so none is dead.
    EXPECT_EQ(state_count(texts), 1 + 2 * 5 + 2);
    EXPECT_EQ(state_count({}), 1);
    EXPECT_EQ(state_count({"C.*[LOB]"}), 1);
    EXPECT_EQ(state_count({"CO"}), 2);                          // start, dead
    EXPECT_EQ(state_count({"C<RD>L"}), 3);                      // start, after RD, dead
    EXPECT_EQ(state_count({"C<RD>[LOB]", "C<RD>.+[LOB]"}), 4);  // start, direct, indirect, dead
    EXPECT_EQ(state_count({"CD{3}L"}), 5);                      // 0, 1, 2, 3 times, dead
    EXPECT_EQ(state_count({"C(DDS|GDS)L", "C[DG]DSL"}), 5);     // start, [DG], D, S, dead
    EXPECT_EQ(state_count({"C[DGS]*L", "C.*L"}), 1);            // every scattering has a mode
    EXPECT_EQ(state_count({"C(DD)*L"}), 3);                     // even, odd, dead
    EXPECT_EQ(state_count({"C.*<RD>.{2}L"}), 8);                // which of the last three are RD
    EXPECT_EQ(state_count({"CD*L", "C(D|DD|DDD)*L"}), 2);       // start, dead
    EXPECT_EQ(state_count({"C<R.'glass'>.*L"}), 1);             // no such lobe: dead
    EXPECT_EQ(state_count({"CD<L'key'>", "CS<L'fill'>"}), 1);   // no such lights: dead
    EXPECT_EQ(state_count({"CD<L'key'>"}, small_alphabet), 3);  // the same with such a light
    EXPECT_EQ(state_count({"C.{0,60}L", "C.{61,}L"}), 62);      // 0 to 60 times, more
    EXPECT_EQ(state_count({"C((((((D{0}){64}){64}){64}){64}){64}){64}L"}), 2);
}

/// The pairs of states that some path distinguishes, by filling a table.
std::vector<std::vector<bool>> distinguished(const PathAutomaton& automaton,
                                             const EventAlphabet& alphabet) {
    const auto count = static_cast<uint16_t>(automaton.state_count());
    std::vector<std::vector<bool>> differ(count, std::vector<bool>(count));
    const auto differ_now = [&](uint16_t a, uint16_t b) {
        for (size_t light = 0; light < alphabet.lights.size(); ++light) {
            if (automaton.accepted(a, light) != automaton.accepted(b, light)) return true;
        }
        for (size_t s = 0; s < alphabet.scatterings.size(); ++s) {
            if (differ[automaton.after_scattering(a, s)][automaton.after_scattering(b, s)])
                return true;
        }
        return false;
    };
    for (bool changed = true; changed;) {
        changed = false;
        for (uint16_t a = 0; a < count; ++a) {
            for (uint16_t b = 0; b < count; ++b) {
                if (differ[a][b] || !differ_now(a, b)) continue;
                differ[a][b] = changed = true;
            }
        }
    }
    return differ;
}

TEST(PathAutomaton, EveryTwoStatesDifferInSomeFuture) {
    RandomExpression random(19);
    for (int batch = 0; batch < 20; ++batch) {
        const PathAutomaton automaton = compiled({random.text(), random.text()}, small_alphabet);
        const auto differ = distinguished(automaton, small_alphabet);
        for (size_t a = 0; a < differ.size(); ++a) {
            for (size_t b = 0; b < differ.size(); ++b)
                ASSERT_EQ(differ[a][b], a != b) << a << " and " << b;
        }
    }
}

/// The states that scatterings lead to from one state, itself included.
std::vector<uint16_t> reachable(const PathAutomaton& automaton, uint16_t from) {
    std::vector<uint16_t> states = {from};
    for (size_t i = 0; i < states.size(); ++i) {
        for (size_t s = 0; s < scattering_names.size(); ++s) {
            const uint16_t next = automaton.after_scattering(states[i], s);
            if (std::find(states.begin(), states.end(), next) == states.end())
                states.push_back(next);
        }
    }
    return states;
}

TEST(PathAutomaton, DeadAndSettledAreWhatTheySay) {
    RandomExpression random(23);
    size_t dead_count = 0;
    size_t settled_count = 0;
    for (int batch = 0; batch < 40; ++batch) {
        const PathAutomaton automaton = compiled({random.text(), random.text()}, small_alphabet);
        const auto count = static_cast<size_t>(automaton.state_count());
        EXPECT_EQ(reachable(automaton, automaton.start()).size(), count);
        for (uint16_t state = 0; state < count; ++state) {
            const std::vector<uint16_t> futures = reachable(automaton, state);
            bool lives = false;
            for (const uint16_t future : futures) {
                for (size_t light = 0; light < light_names.size(); ++light)
                    lives = lives || automaton.accepted(future, light) != 0;
            }
            EXPECT_EQ(automaton.is_dead(state), !lives);
            EXPECT_EQ(automaton.is_settled(state), futures.size() == 1);
            dead_count += automaton.is_dead(state) ? 1 : 0;
            settled_count += automaton.is_settled(state) ? 1 : 0;
        }
    }
    EXPECT_GT(dead_count, 0u);
    EXPECT_GT(settled_count, dead_count);
}

TEST(PathAutomaton, TheLastOf64ExpressionsHasItsBit) {
    std::vector<std::string> texts(63, "CO");
    texts.emplace_back("CB");
    const PathAutomaton automaton = compiled(texts, small_alphabet);
    EXPECT_EQ(automaton.accepted(automaton.start(), 2), ~uint64_t{0} >> 1);
    EXPECT_EQ(automaton.accepted(automaton.start(), 3), uint64_t{1} << 63);
    EXPECT_EQ(automaton.accepted(automaton.start(), 0), 0u);
}

/// The error of expressions that are too many or too large.
Error error_of(const std::vector<std::string>& texts) {
    const auto automaton = PathAutomaton::compile(parsed(texts), surface_alphabet);
    if (automaton) return {};
    EXPECT_EQ(automaton.error().code, ExitCode::usage);
    EXPECT_EQ(automaton.error().id, "E-LPE");
    return automaton.error();
}

TEST(PathAutomaton, RefusesMoreThanItsLimits) {
    const Error many = error_of(std::vector<std::string>(65, "CO"));
    EXPECT_EQ(many.message, "65 are given; at most 64 are accepted");

    // Which of the last 13 scatterings were diffuse: 2^13 states.
    const Error states = error_of({"CO", "C.*D.{12}L"});
    EXPECT_EQ(states.message.substr(0, 45), "together they need more states than the accep");
    EXPECT_EQ(state_count({"C.*D.{9}L"}), 1024);

    // C, L, the end, and 64 events with a branch before each: 131 parts.
    EXPECT_EQ(error_of(std::vector<std::string>(62, "CD{0,64}L")).id, "");
    EXPECT_EQ(error_of(std::vector<std::string>(63, "CD{0,64}L")).where, "CD{0,64}L");
    const Error parts = error_of({"CO", "C(((D{64}){64}){64}){64}L"});
    EXPECT_EQ(parts.where, "C(((D{64}){64}){64}){64}L");
    EXPECT_NE(parts.message.find("more events and branches than the accepted 8192"),
              std::string::npos);
}

}  // namespace
}  // namespace obscura
