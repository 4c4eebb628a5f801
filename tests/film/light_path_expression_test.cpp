// tests/film/light_path_expression_test.cpp - what expressions mean, and where they are refused.
// SPDX-License-Identifier: Apache-2.0
#include "film/light_path_expression.h"

#include <gtest/gtest.h>

namespace obscura {
namespace {

using Kind = PathNode::Kind;

struct NamedScattering {
    char name;
    ScatterEvent event;
};

constexpr NamedScattering scatterings[] = {{'a', {'R', 'D', "diffuse"}},
                                           {'b', {'R', 'G', "specular"}},
                                           {'c', {'R', 'S', "specular"}},
                                           {'d', {'R', 'G', "coat"}},
                                           {'e', {'T', 'D', "diffuse_transmission"}},
                                           {'f', {'T', 'G', "transmission"}},
                                           {'g', {'T', 'S', "transmission"}},
                                           {'h', {'V', 'D', "volume"}}};

struct NamedLight {
    char name;
    LightEvent event;
};

const NamedLight lights[] = {{'K', {'L', "key"}},
                             {'F', {'L', "fill"}},
                             {'O', {'O', ""}},
                             {'P', {'O', "key"}},
                             {'B', {'B', ""}}};

/// The names of the events above that an event as text accepts.
std::string names_of(const std::string& event) {
    // A light may follow another in the text: it is the first one that is optional.
    const auto expression = parse_light_path_expression("C" + event + "?L");
    if (!expression) return expression.error().message;
    const EventSet& events = expression->nodes[1].events;
    std::string names;
    for (const NamedScattering& scattering : scatterings) {
        if (matches(events, scattering.event)) names += scattering.name;
    }
    for (const NamedLight& light : lights) {
        if (matches(events, light.event)) names += light.name;
    }
    return names;
}

/// A tree as text: e for an event, (x y) for a sequence, [x y] for a choice.
std::string tree_text(const LightPathExpression& expression, const PathNode& node) {
    if (node.kind == Kind::camera) return "C";
    if (node.kind == Kind::event) return "e";
    std::string children;
    for (const size_t child : node.children) {
        children += children.empty() ? "" : " ";
        children += tree_text(expression, expression.nodes[child]);
    }
    if (node.kind == Kind::sequence) return "(" + children + ")";
    if (node.kind == Kind::choice) return "[" + children + "]";
    return children + "{" + std::to_string(node.min_count) + "," + std::to_string(node.max_count) +
           "}";
}

std::string tree_of(const std::string& text) {
    const auto expression = parse_light_path_expression(text);
    return expression ? tree_text(*expression, expression->nodes.back())
                      : expression.error().message;
}

std::string repeated(const std::string& text, size_t count) {
    std::string out;
    for (size_t i = 0; i < count; ++i)
        out += text;
    return out;
}

struct EventCase {
    const char* event;
    const char* accepted;  ///< by name
};

constexpr EventCase event_cases[] = {
    {"R", "abcd"},
    {"T", "efg"},
    {"V", "h"},
    {"D", "aeh"},
    {"G", "bdf"},
    {"S", "cg"},
    {"L", "KF"},
    {"O", "OP"},
    {"B", "B"},
    {"<R>", "abcd"},
    {"<RG>", "bd"},
    {"<R.'coat'>", "d"},
    {"<R'coat'>", "d"},
    {"<RD.>", "a"},
    {"<.[GS]>", "bcdfg"},
    {"<.D>", "aeh"},
    {"<.[^S]>", "abdefhKFOPB"},
    {"<R[^S]>", "abd"},
    {"<[RT]G>", "bdf"},
    {"<[^R]>", "efghKFOPB"},
    {"<[^R]D>", "eh"},
    {"<[^RTV]>", "KFOPB"},
    {"<[RL]>", "abcdKF"},
    {"<[RL]G>", "bd"},
    {"<L'key'>", "K"},
    {"<L.'key'>", "K"},
    {"<L..>", "KF"},
    {"<[LOB]'key'>", "KP"},
    {"<.'key'>", "KP"},
    {"<O''>", "O"},
    {"<R.'*'>", "abcd"},
    {"<R.'*e*'>", "abc"},
    {"<R.'c**t'>", "d"},
    {"<..'d*n'>", "e"},
    {"<..'t*s*n'>", "fg"},
    {"<..'*sion*'>", "efg"},
    {"<RG['coat' 'specular']>", "bd"},
    {"<RG[^'coat']>", "b"},
    {"<R.[^'dif*' 'coat']>", "bc"},
    {"<R[^S][^'*u*']>", "d"},
    {"[DG]", "abdefh"},
    {"[LO]", "KFOP"},
    {"[R<L'key'>]", "abcdK"},
    {"[<RD><TG>]", "af"},
    {"[^S]", "abdefhKFOPB"},
    {"[^LOB]", "abcdefgh"},
    {"[^RS]", "efhKFOPB"},
    {"[^<RD>L]", "bcdefghOPB"},
    {"[^D<.'coat'>]", "bcfgKFOPB"},
    {" < R [ ^ S ] 'coat' > ", "d"},
    {"[ ^ S\tL ]", "abdefhOPB"},
    {"<R.' coat'>", ""},
};

TEST(LightPathExpression, AnEventAcceptsWhatItsNotationSays) {
    for (const EventCase& c : event_cases)
        EXPECT_EQ(names_of(c.event), c.accepted) << c.event;
    for (const char* event : {".", "<.>", "<..>", "<...>", "<..'*'>", "[.]", "[^<R.'none'>]"})
        EXPECT_EQ(names_of(event), "abcdefghKFOPB") << event;
}

TEST(LightPathExpression, OperatorsBindAsInRegularExpressions) {
    EXPECT_EQ(tree_of("CDL"), "(C e e)");
    EXPECT_EQ(tree_of("CDL|CO|CB"), "[(C e e) (C e) (C e)]");
    EXPECT_EQ(tree_of("(CDL)|(CO)"), "[(C e e) (C e)]");
    EXPECT_EQ(tree_of("C(D|SD)L"), "(C [e (e e)] e)");
    EXPECT_EQ(tree_of("C(DS)L"), "(C (e e) e)");
    EXPECT_EQ(tree_of("CD*S+G?L"), "(C e{0,-1} e{1,-1} e{0,1} e)");
    EXPECT_EQ(tree_of("CD{2}S{1,3}G{4,}R{0}L"), "(C e{2,2} e{1,3} e{4,-1} e{0,0} e)");
    EXPECT_EQ(tree_of("C(DS)*(G*)?L"), "(C (e e){0,-1} e{0,-1}{0,1} e)");
    EXPECT_EQ(tree_of(" C\tD { 2 , 13 }\n( S | G ) L "), "(C e{2,13} [e e] e)");
}

TEST(LightPathExpression, KeepsItsTextAndColumns) {
    const auto expression = parse_light_path_expression("C <RD> [LO]");
    ASSERT_TRUE(expression);
    EXPECT_EQ(expression->text, "C <RD> [LO]");
    ASSERT_EQ(expression->nodes.size(), 4u);
    EXPECT_EQ(expression->nodes[0].column, 1u);
    EXPECT_EQ(expression->nodes[1].column, 3u);
    EXPECT_EQ(expression->nodes[2].column, 8u);
    EXPECT_EQ(expression->nodes[3].kind, Kind::sequence);
}

struct Refused {
    std::string text;
    std::string message;  ///< how it begins
};

void expect_refused(const Refused& c) {
    const auto expression = parse_light_path_expression(c.text);
    ASSERT_FALSE(expression) << c.text;
    const Error& error = expression.error();
    EXPECT_EQ(error.code, ExitCode::usage) << c.text;
    EXPECT_EQ(error.id, "E-LPE") << c.text;
    EXPECT_EQ(error.where, c.text.substr(0, 80));
    EXPECT_EQ(error.message.substr(0, c.message.size()), c.message) << c.text;
}

TEST(LightPathExpression, RefusesWhatIsNoEvent) {
    for (const Refused& c :
         {Refused{"", "column 1: the end of the expression is no event; events are C, R, T, V"},
          Refused{"CQL", "column 2: 'Q' is no event; events are C, R, T, V, D, G, S, L, O, B, '.'"},
          Refused{"CD  xL", "column 5: 'x' is no event; events are C"},
          Refused{"C-L", "column 2: '-' is no event; events are C"},
          Refused{"CD'coat'L", "column 3: ''' is no event; events are C"},
          Refused{"C\xC3L", "column 2: a character that is not printable ASCII is no event"},
          Refused{{'C', '\0', 'L'}, "column 2: a character that is not printable ASCII is not"},
          Refused{"C[DL", "column 5: the end of the expression is no event; events in a set are R"},
          Refused{"C[]L", "column 3: ']' is no event; events in a set are R"},
          Refused{"C[^]L", "column 4: ']' is no event; events in a set are R"},
          Refused{"C[C]L", "column 3: 'C' is no event; events in a set are R"}}) {
        expect_refused(c);
    }
}

TEST(LightPathExpression, RefusesWhatIsNotInAngleBrackets) {
    for (const Refused& c :
         {Refused{"C<", "column 3: the end of the expression is not accepted here, but a type"},
          Refused{"C<>L", "column 3: '>' is not accepted here, but a type (R, T, V, L, O, B)"},
          Refused{"C<DR>L", "column 3: 'D' is not accepted here, but a type (R, T, V, L, O, B)"},
          Refused{"C<RT>L", "column 4: 'T' is not accepted here, but a mode (D, G, S), '.', a set"},
          Refused{"C<R->L", "column 4: '-' is not accepted here, but a mode (D, G, S)"},
          Refused{"C<[RX]D>L", "column 5: 'X' is not accepted here, but one or more of R, T, V"},
          Refused{"C<[]D>L", "column 4: ']' is not accepted here, but one or more of R, T, V"},
          Refused{"C<R[GX]>L", "column 6: 'X' is not accepted here, but one or more of D, G, S"},
          Refused{"C<R[G", "column 6: the end of the expression is not accepted here, but one or"},
          Refused{"C<LD>", "column 4: 'D' is not accepted here, but a label in quotes or '>', as"},
          Refused{"C<RDG>L", "column 5: 'G' is not accepted here, but a label in quotes or '>'"},
          Refused{"C<RD'coat>L", "column 5: the label that begins here has no second quote"},
          Refused{"C<RD['a' x]>L", "column 10: 'x' is not accepted here, but a label in quotes"},
          Refused{"C<RD'a''b'>L", "column 8: ''' is not accepted here, but '>'"},
          Refused{"C<RD.'a'>L", "column 6: ''' is not accepted here, but '>'"}}) {
        expect_refused(c);
    }
}

TEST(LightPathExpression, RefusesOperatorsOutOfPlace) {
    for (const Refused& c :
         {Refused{"*L", "column 1: '*' is no event"},
          Refused{"C(DL", "column 5: the end of the expression is not accepted here, but an event"},
          Refused{"CD)L", "column 3: ')' is not accepted here, but an event or an operator"},
          Refused{"C()L", "column 3: ')' is no event"},
          Refused{"C(|D)L", "column 3: '|' is no event"},
          Refused{"CD(L|)", "column 6: ')' is no event"},
          Refused{"CD**L", "column 4: '*' is not accepted here, but an event, '|', ')'"},
          Refused{"CD{}L", "column 4: '}' is not accepted here, but a number, as in {2}, {2,4}"},
          Refused{"CD{,2}L", "column 4: ',' is not accepted here, but a number"},
          Refused{"CD{2;}L", "column 5: ';' is not accepted here, but a digit, ',' or '}'"},
          Refused{"CD{2", "column 5: the end of the expression is not accepted here, but a digit"},
          Refused{"CD{3,2}L", "column 6: {n,m} is accepted with m not below n only"}}) {
        expect_refused(c);
    }
}

TEST(LightPathExpression, RefusesEventsOutOfOrder) {
    for (const Refused& c :
         {Refused{"DL", "column 1: a path begins with the camera: C is accepted here"},
          Refused{"C?L", "column 3: a path begins with the camera"},
          Refused{"CL|O", "column 4: a path begins with the camera"},
          Refused{"CD|(SD)L", "column 5: a path begins with the camera"},
          Refused{"CDCL", "column 3: C is accepted as the first event only"},
          Refused{"C+L", "column 1: C is accepted as the first event only"},
          Refused{"C(DC?)*L", "column 4: C is accepted as the first event only"},
          Refused{"CLD", "column 3: nothing follows a light: the end is accepted here"},
          Refused{"CO{1,2}[^LOB]", "column 8: nothing follows a light"},
          Refused{"CL{2}", "no path fits it: nothing follows a light"},
          Refused{"C[^.]L", "column 2: no event fits this"},
          Refused{"CD<R[^DGS]>L", "column 3: no event fits this"}}) {
        expect_refused(c);
    }
}

TEST(LightPathExpression, RefusesPathsWithoutALightAtTheirEnd) {
    for (const char* text : {"C",
                             "CD",
                             "C.*",
                             "CDL?",
                             "C[^S]",
                             "C[DL]",
                             "CO|CD",
                             "CD{0,3}",
                             "C<[RL]>",
                             "C(D|L)*",
                             "CL{0}",
                             "C[^L<O'key'>]"}) {
        expect_refused(
            {text, "it accepts paths that do not end with a light; end it with L, O, B"});
    }
    for (const char* text : {"CL",
                             "C.*[LOB]",
                             "C<[^RTV]>",
                             "C[^RTV]",
                             "C(D|L)*O",
                             "CD{0}O",
                             "C[LO]?B",
                             "C[^DGS]",
                             "C(L|D+B)",
                             "(CL|C)[OB]"}) {
        EXPECT_TRUE(parse_light_path_expression(text)) << text;
    }
}

TEST(LightPathExpression, AcceptsItsLimitsAndNoMore) {
    EXPECT_TRUE(parse_light_path_expression("CD{64}S{0,64}G{64,}L"));
    expect_refused({"CD{65}L", "column 4: counts from 0 to 64 are accepted"});
    expect_refused({"CD{1,65}L", "column 6: counts from 0 to 64 are accepted"});
    expect_refused({"CD{99999999999}L", "column 4: counts from 0 to 64 are accepted"});

    const auto nested = [](size_t depth) {
        return "C" + repeated("(", depth) + "D" + repeated(")*", depth) + "L";
    };
    EXPECT_TRUE(parse_light_path_expression(nested(64)));
    expect_refused({nested(65), "column 66: 64 parentheses within each other are accepted"});

    EXPECT_TRUE(parse_light_path_expression("C" + repeated("D", 4094) + "L"));
    expect_refused({"C" + repeated("D", 4095) + "L",
                    "column 4097: the expression is longer than the accepted 4096 bytes"});
}

}  // namespace
}  // namespace obscura
