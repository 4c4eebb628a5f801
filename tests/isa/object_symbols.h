// tests/isa/object_symbols.h - finds functions that the linker could hand to a CPU that lacks them.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace obscura::isa {

/// One instruction set above the floor, and the marks that make a symbol its own.
struct InstructionSet {
    std::string_view name;  ///< as in isa_objects_<name>.txt
    std::string_view own_namespace;
    /// Vector types of this set. Not those of a lower set: its objects may hold the same symbol.
    std::vector<std::string_view> own_types;
};

inline const std::vector<InstructionSet> instruction_sets{
    {"avx2", "isa_avx2::", {"xsimd::avx2", "xsimd::avx,", "xsimd::avx>"}},
    {"avx512", "isa_avx512::", {"xsimd::avx512"}}};

/// One line of `nm --demangle --defined-only --format=sysv`.
struct Symbol {
    std::string name;
    char kind = ' ';      ///< W, V and u are merged by the linker: one copy serves everybody
    std::string section;  ///< ".text..." is code
};

inline std::string_view trim(std::string_view text) {
    while (!text.empty() && text.front() == ' ')
        text.remove_prefix(1);
    while (!text.empty() && text.back() == ' ')
        text.remove_suffix(1);
    return text;
}

/// Reads one line: name|value|class|type|size|line|section, where the name may hold | itself.
/// Other lines (titles, empty ones) give nothing.
inline std::optional<Symbol> parse_symbol(std::string_view line) {
    std::array<std::string_view, 7> fields;
    for (size_t i = fields.size() - 1; i > 0; --i) {
        const size_t bar = line.rfind('|');
        if (bar == std::string_view::npos) return std::nullopt;
        fields[i] = trim(line.substr(bar + 1));
        line = line.substr(0, bar);
    }
    fields[0] = trim(line);
    if (fields[2].size() != 1) return std::nullopt;
    return Symbol{std::string(fields[0]), fields[2][0], std::string(fields[6])};
}

/// Code of which the linker keeps one copy out of many object files.
inline bool is_shared_code(const Symbol& symbol) {
    const bool merged = symbol.kind == 'W' || symbol.kind == 'V' || symbol.kind == 'u';
    return merged && symbol.section.starts_with(".text");
}

/// True when no object file of another instruction set can define the same symbol, or when the
/// symbol is the same machine code everywhere.
inline bool is_safe(const Symbol& symbol, const InstructionSet& isa) {
    // Clang's handler of exceptions that leave noexcept functions: two calls, no vectors.
    if (symbol.name == "__clang_call_terminate") return true;
    if (symbol.name.find(isa.own_namespace) != std::string::npos) return true;
    for (const std::string_view type : isa.own_types) {
        if (symbol.name.find(type) != std::string::npos) return true;
    }
    return false;
}

/// Text in single quotes for a POSIX shell.
inline std::string shell_quoted(std::string_view text) {
    std::string quoted = "'";
    for (const char c : text) {
        if (c == '\'') {
            quoted += "'\\''";
        } else {
            quoted += c;
        }
    }
    return quoted + "'";
}

/// All symbols that an object file defines; nothing when `nm` fails.
inline std::optional<std::vector<Symbol>> read_symbols(const std::string& nm,
                                                       const std::string& object) {
    const std::string command =
        shell_quoted(nm) + " --demangle --defined-only --format=sysv " + shell_quoted(object);
    FILE* pipe = popen(command.c_str(), "r");
    if (pipe == nullptr) return std::nullopt;
    std::string text;
    std::array<char, 65536> block;
    while (const size_t size = fread(block.data(), 1, block.size(), pipe)) {
        text.append(block.data(), size);
    }
    if (pclose(pipe) != 0) return std::nullopt;

    std::vector<Symbol> symbols;
    size_t begin = 0;
    while (begin < text.size()) {
        const size_t end = std::min(text.find('\n', begin), text.size());
        if (const auto symbol = parse_symbol(std::string_view(text).substr(begin, end - begin))) {
            symbols.push_back(*symbol);
        }
        begin = end + 1;
    }
    return symbols;
}

}  // namespace obscura::isa
