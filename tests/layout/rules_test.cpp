// tests/layout/rules_test.cpp - shows that each layout rule passes good text and refuses bad text.
// SPDX-License-Identifier: Apache-2.0
#include "layout/rules.h"

#include <gtest/gtest.h>

#include "layout/standard_names.h"
#include <gmock/gmock.h>
#include <sstream>
#include <string>

namespace obscura::layout {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

/// `count` lines of statements.
std::string statements(size_t count) {
    std::string text;
    for (size_t i = 0; i < count; ++i)
        text += "    work();\n";
    return text;
}

std::vector<std::string> names(std::string_view text) {
    std::vector<std::string> out;
    for (const Function& function : find_functions(text).functions)
        out.push_back(function.name);
    return out;
}

TEST(LayoutIncludes, OwnRoomAndRoomsAboveAreFine) {
    EXPECT_THAT(check_includes("scene/scene.h",
                               "#include \"scene/asset_info.h\"\n"
                               "#include \"base/error.h\"\n"
                               "#  include <vector>\n"
                               "#include <sys/stat.h>\n"
                               "#include <cstdint>  // why\n"),
                IsEmpty());
}

TEST(LayoutIncludes, RoomFurtherDownIsRefused) {
    EXPECT_THAT(check_includes("light/sun.cpp", "\n#include \"scene/scene.h\"\n"),
                ElementsAre(HasSubstr("light/sun.cpp:2: light may not include scene")));
    EXPECT_THAT(check_includes("gltf/load.cpp", "  # include \"accel/accel.h\"\n"),
                ElementsAre(HasSubstr("gltf may not include accel")));
}

TEST(LayoutIncludes, QuotedNameMustBeginWithARoom) {
    EXPECT_THAT(check_includes("base/log.cpp", "#include \"log.h\"\n#include \"../a/b.h\"\n"),
                ElementsAre(HasSubstr("\"log.h\""), HasSubstr("\"../a/b.h\"")));
    EXPECT_THAT(check_includes("app/main.cpp", "#include \"tests/support/x.h\"\n"),
                ElementsAre(HasSubstr("does not begin with a room")));
}

TEST(LayoutIncludes, LibrariesStayInTheirRoom) {
    EXPECT_THAT(check_includes("base/parallel.cpp", "#include <tbb/parallel_for.h>\n"), IsEmpty());
    EXPECT_THAT(check_includes("render/tiles.cpp", "#include <tbb/parallel_for.h>\n"),
                ElementsAre(HasSubstr("belongs to base, not to render")));
    EXPECT_THAT(check_includes("stages/wavefront.cpp", "#include <embree4/rtcore.h>\n"),
                ElementsAre(HasSubstr("belongs to accel")));
    EXPECT_THAT(check_includes("surface/bsdf.h", "#include <xsimd/xsimd.hpp>\n"),
                ElementsAre(HasSubstr("belongs to math")));
}

TEST(LayoutIncludes, UnknownLibraryNeedsAnOwner) {
    EXPECT_THAT(check_includes("image/x.cpp", "#include <tiff.h>\n#include <boost/any.hpp>\n"),
                ElementsAre(HasSubstr("<tiff.h> has no owner"), HasSubstr("<boost/any.hpp>")));
}

TEST(LayoutIncludes, FilesOutsideRoomsAreRefused) {
    EXPECT_THAT(check_includes("util/x.h", ""), ElementsAre(HasSubstr("lies in no room")));
    EXPECT_THAT(check_includes("main.cpp", ""), ElementsAre(HasSubstr("lies in no room")));
}

TEST(LayoutIncludes, EveryOwnerIsARoom) {
    for (const Owner& owner : owners) {
        std::istringstream words{std::string(owner.rooms)};
        for (std::string word; words >> word;)
            EXPECT_TRUE(room_number(word)) << word;
    }
}

TEST(LayoutHead, PathPurposeLicenceAndPragma) {
    const std::string spdx = "// SPDX-License-Identifier: Apache-2.0\n";
    EXPECT_THAT(check_head("base/a.h", "// base/a.h - does it.\n" + spdx + "#pragma once\n"),
                IsEmpty());
    EXPECT_THAT(check_head("base/a.cpp", "// base/a.cpp - does it.\n" + spdx), IsEmpty());
    EXPECT_THAT(check_head("base/a.cpp", "// base/b.cpp - does it.\n" + spdx),
                ElementsAre(HasSubstr("base/a.cpp:1: write `// base/a.cpp - ")));
    EXPECT_THAT(check_head("base/a.cpp", "// base/a.cpp - no full stop\n" + spdx),
                ElementsAre(HasSubstr("base/a.cpp:1:")));
    EXPECT_THAT(check_head("base/a.cpp", "// base/a.cpp - does it.\n#include <vector>\n"),
                ElementsAre(HasSubstr("base/a.cpp:2:")));
    EXPECT_THAT(check_head("base/a.h", "// base/a.h - does it.\n" + spdx + "\n#include <map>\n"),
                ElementsAre(HasSubstr("base/a.h:4: write `#pragma once`")));
    EXPECT_THAT(check_head("base/a.h",
                           "// base/a.h - does it.\n" + spdx + "//\n// More.\n\n#pragma once\n"),
                IsEmpty());
    EXPECT_THAT(check_head("a.cpp", "// a.cpp - " + std::string(90, 'x') + ".\n" + spdx),
                ElementsAre(HasSubstr("a.cpp:1: say it within 100 columns")));
    EXPECT_EQ(check_head("base/a.h", "").size(), 3U);
}

TEST(LayoutIncludes, TheInsideOfALargeRoomIsItsOwn) {
    EXPECT_THAT(check_includes("gltf/load.cpp", "#include \"gltf/pose.h\"\n"), IsEmpty());
    EXPECT_THAT(check_includes("bench/a.cpp", "#include \"gltf/load.h\"\n"), IsEmpty());
    EXPECT_THAT(check_includes("bench/a.cpp", "#include \"gltf/pose.h\"\n"),
                ElementsAre(HasSubstr("bench/a.cpp:1: \"gltf/pose.h\" is inside its room")));
}

TEST(LayoutSizes, FiveHundredLinesAreTheLimit) {
    EXPECT_THAT(check_sizes("a.cpp", std::string(500, '\n')), IsEmpty());
    EXPECT_THAT(check_sizes("a.cpp", std::string(501, '\n')),
                ElementsAre(HasSubstr("the file has 501 lines")));
}

TEST(LayoutSizes, ALineHasAHundredColumns) {
    EXPECT_THAT(check_columns("a.cpp", std::string(100, 'x') + "\n"), IsEmpty());
    EXPECT_THAT(check_columns("a.cpp", "\xC3\xA9" + std::string(99, 'x') + "\n"), IsEmpty());
    EXPECT_THAT(check_columns("a.cpp", "\n" + std::string(101, 'x') + "\n"),
                ElementsAre(HasSubstr("a.cpp:2: the line has 101 columns")));
}

TEST(LayoutSizes, FiveParametersAreTheLimit) {
    for (const std::string head : {"void f()",
                                   "void f(int a, int b, int c, int d, int e)",
                                   "S::S(int a) : a_(a), b_(1), c_(2), d_(3), e_(4), g_(5)",
                                   "void f(std::map<int, std::pair<int, int>> a, int (&b)[6])",
                                   "void f(A a = {1, 2, 3, 4, 5, 6}, B b = g(1, 2, 3, 4, 5))"}) {
        EXPECT_THAT(check_parameters("a.cpp", head + " { }\n"), IsEmpty()) << head;
    }
    for (const std::string head :
         {"void f(int a, int b, int c, int d, int e, int g)",
          "bool operator()(int a, int b, int c, int d, int e, int g)",
          "template <class A, class B> void f(A a, B b, A c, B d, A e, B g)"}) {
        EXPECT_THAT(check_parameters("a.cpp", head + " { }\n"),
                    ElementsAre(HasSubstr("has 6 parameters")))
            << head;
    }
}

TEST(LayoutSizes, SixtyLinesAreTheLimitOfAFunction) {
    EXPECT_THAT(check_sizes("a.cpp", "void f() {\n" + statements(58) + "}\n"), IsEmpty());
    EXPECT_THAT(check_sizes("a.cpp", "\nvoid f() {\n" + statements(59) + "}\n"),
                ElementsAre(HasSubstr("a.cpp:2: `void f` has 61 lines")));
}

TEST(LayoutSizes, MethodsConstructorsTemplatesAndTestsAreMeasured) {
    const std::string body = "{\n" + statements(60) + "}\n";
    for (const std::string head :
         {"TEST(A, B) ",
          "template <class T, typename F = std::less<T>>\nT f(T a) ",
          "namespace a::b { struct C { private: int f() const noexcept ",
          "class alignas(64) C final : public D { C(int i) : a_(i), b_{i} ",
          "bool operator==(const C& a, const C& b) ",
          "auto f(C c = {}) -> std::vector<int> ",
          "[[nodiscard]] static bool f() ",
          "constexpr auto f = [](int i) ",
          "extern \"C\" { void f() "}) {
        const std::string closing = head.find("{ struct") != std::string::npos ? "};}"
                                    : head.find("class alignas") == 0          ? "};"
                                    : head.find("extern") == 0                 ? "}"
                                                                               : ";";
        EXPECT_THAT(check_sizes("a.cpp", head + body + closing),
                    ElementsAre(HasSubstr("lines; at most 60")))
            << head;
    }
}

TEST(LayoutSizes, TypesNamespacesAndTablesMayBeLong) {
    const std::string rows = statements(70);
    for (const std::string head : {"namespace obscura::a {\n",
                                   "enum class E : int {\n",
                                   "struct S : Base<int> {\n",
                                   "template <typename T> struct alignas(16) S {\n",
                                   "const std::array<int, size(3)> table = {\n",
                                   "constexpr Entry table[] = {\n"}) {
        EXPECT_THAT(check_sizes("a.cpp", head + rows + "};\n"), IsEmpty()) << head;
    }
}

TEST(LayoutSizes, BracesInTextDoNotCount) {
    EXPECT_THAT(check_sizes("a.cpp",
                            "void f() { // {\n  g(\"{\", '{', R\"x({ \" )\" {)x\"); /* {{ */\n"
                            "  int i = 1'000; char c = '\\'';\n}\n"
                            "#define OPEN {\\\n   {\nvoid g() {}\n"),
                IsEmpty());
}

TEST(LayoutSizes, UnbalancedBracesAreReported) {
    EXPECT_THAT(check_sizes("a.cpp", "void f() {\n"), ElementsAre(HasSubstr("do not balance")));
    EXPECT_THAT(check_sizes("a.cpp", "}\n"), ElementsAre(HasSubstr("do not balance")));
    EXPECT_THAT(check_sizes("a.cpp", "namespace a {\n"), ElementsAre(HasSubstr("do not balance")));
}

TEST(LayoutStandardNames, NeedTheirHeaderFromAnywhere) {
    const std::map<std::string, std::vector<Include>> includes = {
        {"a.h", find_includes("#include <vector>\n#include \"b.h\"\n")},
        {"b.h", find_includes("#include <map>\n#include \"a.h\"\n")},
        {"c.cpp", find_includes("#include \"a.h\"\n")},
        {"d.cpp", {}}};
    const std::string text =
        "std::vector<int> a;  // std::optional\nstd::map<int, my_std::mutex> b;\nstd::vector<int> "
        "c;\n";
    const auto check = [&](const std::string& file) {
        return check_standard_names(file, text, library_headers_of(file, includes));
    };
    EXPECT_THAT(check("c.cpp"), IsEmpty());
    EXPECT_THAT(check("d.cpp"),
                UnorderedElementsAre("d.cpp:1: std::vector needs #include <vector>",
                                     "d.cpp:2: std::map needs #include <map>"));
}

TEST(LayoutFunctions, AreFoundByName) {
    EXPECT_THAT(names("int a() { if (x) { y(); } return 1; }\n"
                      "struct S { S() : m{1}, n(2) {} ~S() {} int k = f(); };\n"
                      "S::S(int i) : m{i} { }\n"
                      "int table[] = {1, 2};\n"
                      "Thing thing{1};\n"
                      "void b();\n"
                      "void c(Options o = {}) {}\n"),
                ElementsAre("int a", "S", "~S", "S::S", "void c"));
}

TEST(LayoutFunctions, BeginWhereTheirHeadBegins) {
    const FunctionList found = find_functions(
        "\n/// Says why.\ntemplate <class T>\nvoid f(\n"
        "    int a)\n{\n}\n");
    ASSERT_EQ(found.functions.size(), 1U);
    EXPECT_EQ(found.functions[0].first_line, 3U);
    EXPECT_EQ(found.functions[0].last_line, 7U);
}

}  // namespace
}  // namespace obscura::layout
