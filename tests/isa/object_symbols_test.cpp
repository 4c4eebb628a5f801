// tests/isa/object_symbols_test.cpp - no code of a higher instruction set can reach an older CPU.
// SPDX-License-Identifier: Apache-2.0
#include "isa/object_symbols.h"

#include <gtest/gtest.h>

#include <fstream>

namespace obscura::isa {
namespace {

const InstructionSet& avx2 = instruction_sets[0];
const InstructionSet& avx512 = instruction_sets[1];

Symbol weak_code(const std::string& name) {
    return {name, 'W', ".text._Z1f"};
}

TEST(ObjectSymbols, LinesOfNmAreRead) {
    const auto symbol = parse_symbol(
        "a::operator|(a::M, a::M)|0000000000000010|   W  |              FUNC|0000000000000051|"
        "     |.text._ZN1aorENS_1MES0_");
    ASSERT_TRUE(symbol);
    EXPECT_EQ(symbol->name, "a::operator|(a::M, a::M)");
    EXPECT_EQ(symbol->kind, 'W');
    EXPECT_EQ(symbol->section, ".text._ZN1aorENS_1MES0_");
}

TEST(ObjectSymbols, TitlesAreNotSymbols) {
    EXPECT_FALSE(parse_symbol(""));
    EXPECT_FALSE(parse_symbol("Symbols from a.o:"));
    EXPECT_FALSE(parse_symbol("Name | Value | Class | Type | Size | Line | Section"));
}

TEST(ObjectSymbols, OnlyMergedCodeIsAskedFor) {
    EXPECT_TRUE(is_shared_code({"f()", 'W', ".text._Z1fv"}));
    EXPECT_TRUE(is_shared_code({"f()", 'u', ".text.unlikely._Z1fv"}));
    EXPECT_FALSE(is_shared_code({"f()", 'T', ".text"}));
    EXPECT_FALSE(is_shared_code({"f()", 't', ".text"}));
    EXPECT_FALSE(is_shared_code({"typeinfo for S", 'V', ".data.rel.ro._ZTI1S"}));
}

TEST(ObjectSymbols, CodeOfThisInstructionSetIsSafe) {
    EXPECT_TRUE(is_safe(weak_code("obscura::isa_avx2::dot(int)"), avx2));
    EXPECT_TRUE(is_safe(weak_code("xsimd::batch<float, xsimd::fma3<xsimd::avx2> >::f()"), avx2));
    EXPECT_TRUE(is_safe(weak_code("xsimd::types::simd_register<float, xsimd::avx>::f()"), avx2));
    EXPECT_TRUE(is_safe(weak_code("void f<obscura::isa_avx512::Lanes>(int)"), avx512));
    EXPECT_TRUE(is_safe(weak_code("xsimd::kernel::add<xsimd::avx512bw>(int)"), avx512));
    EXPECT_TRUE(is_safe(weak_code("__clang_call_terminate"), avx512));
}

TEST(ObjectSymbols, CodeThatOthersMayShareIsNot) {
    EXPECT_FALSE(is_safe(weak_code("std::vector<int>::size() const"), avx2));
    EXPECT_FALSE(is_safe(weak_code("obscura::length(float)"), avx512));
    EXPECT_FALSE(is_safe(weak_code("obscura::isa_avx2::dot(int)"), avx512));
    EXPECT_FALSE(is_safe(weak_code("obscura::isa_avx512::dot(int)"), avx2));
    EXPECT_FALSE(is_safe(weak_code("xsimd::batch<float, xsimd::fma3<xsimd::avx2> >::f()"), avx512));
    EXPECT_FALSE(is_safe(weak_code("xsimd::batch<float, xsimd::avx512bw>::f()"), avx2));
    EXPECT_FALSE(is_safe(weak_code("xsimd::batch<float, xsimd::sse4_2>::f()"), avx2));
}

TEST(ObjectSymbols, MissingObjectsAreAnError) {
    EXPECT_FALSE(read_symbols(OBSCURA_NM, "/does/not/exist.o"));
    EXPECT_FALSE(read_symbols("/does/not/exist/nm", OBSCURA_BINARY_DIR "/CMakeCache.txt"));
}

/// The object files that CMake lists for an instruction set, one a line.
std::vector<std::string> listed_objects(std::istream& list) {
    std::vector<std::string> objects;
    for (std::string line; std::getline(list, line);) {
        if (!line.empty()) objects.push_back(line);
    }
    return objects;
}

void expect_safe_objects(const InstructionSet& isa) {
#if !defined(__x86_64__)
    GTEST_SKIP() << "one instruction set only";
#endif
    std::ifstream list(std::string(OBSCURA_BINARY_DIR "/isa_objects_") + std::string(isa.name) +
                       ".txt");
    if (!list) GTEST_SKIP() << "this build leaves " << isa.name << " out (OBSCURA_ISAS)";
    const std::vector<std::string> objects = listed_objects(list);
    ASSERT_FALSE(objects.empty()) << "CMake lists no object files for " << isa.name;
    bool found_own = false;
    for (const std::string& object : objects) {
        const auto symbols = read_symbols(OBSCURA_NM, object);
        ASSERT_TRUE(symbols) << OBSCURA_NM << " cannot read " << object;
        for (const Symbol& symbol : *symbols) {
            found_own = found_own || symbol.name.find(isa.own_namespace) != std::string::npos;
            EXPECT_TRUE(!is_shared_code(symbol) || is_safe(symbol, isa))
                << object << "\n  defines " << symbol.name << "\n  in " << symbol.section
                << "\n  outside of " << isa.own_namespace
                << " so the linker may keep this copy for every CPU";
        }
    }
    EXPECT_TRUE(found_own) << "nothing in these objects belongs to " << isa.own_namespace;
}

TEST(Objects, OfAvx2HoldNoCodeThatOlderProcessorsMightRun) {
    expect_safe_objects(avx2);
}

TEST(Objects, OfAvx512HoldNoCodeThatOlderProcessorsMightRun) {
    expect_safe_objects(avx512);
}

}  // namespace
}  // namespace obscura::isa
