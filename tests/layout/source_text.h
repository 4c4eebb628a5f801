// tests/layout/source_text.h - takes C++ text apart: lines, includes, functions.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace obscura::layout {

inline bool is_word(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}
inline bool is_space(char c) {
    return std::isspace(static_cast<unsigned char>(c)) != 0;
}

/// One text out of several.
inline std::string join(std::initializer_list<std::string_view> parts) {
    std::string text;
    for (const std::string_view part : parts)
        text += part;
    return text;
}

inline std::vector<std::string> split_lines(std::string_view text) {
    std::vector<std::string> lines;
    while (!text.empty()) {
        const size_t end = std::min(text.find('\n'), text.size());
        lines.emplace_back(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return lines;
}

/// End of the comment that begins at `begin` (the newline itself stays).
inline size_t comment_end(std::string_view text, size_t begin) {
    if (text[begin + 1] == '/') return std::min(text.find('\n', begin), text.size());
    const size_t close = text.find("*/", begin + 2);
    return close == std::string_view::npos ? text.size() : close + 2;
}

/// End of the string or character literal whose opening quote is at `quote`.
inline size_t literal_end(std::string_view text, size_t quote) {
    const bool raw = text[quote] == '"' && quote > 0 && text[quote - 1] == 'R';
    if (raw) {
        const size_t open = text.find('(', quote);
        if (open == std::string_view::npos) return text.size();
        const std::string close = join({")", text.substr(quote + 1, open - quote - 1), "\""});
        const size_t end = text.find(close, open);
        return end == std::string_view::npos ? text.size() : end + close.size();
    }
    size_t i = quote + 1;
    while (i < text.size() && text[i] != text[quote])
        i += text[i] == '\\' ? 2 : 1;
    return std::min(i + 1, text.size());
}

/// True when the ' at `at` separates digits, as in 1'000.
inline bool is_digit_separator(std::string_view text, size_t at) {
    size_t begin = at;
    while (begin > 0 && (is_word(text[begin - 1]) || text[begin - 1] == '\''))
        --begin;
    return begin < at && std::isdigit(static_cast<unsigned char>(text[begin])) != 0;
}

/// End of the preprocessor line that begins at `begin`, with its continuation lines.
inline size_t directive_end(std::string_view text, size_t begin) {
    size_t end = std::min(text.find('\n', begin), text.size());
    while (end < text.size() && text[end - 1] == '\\') {
        end = std::min(text.find('\n', end + 1), text.size());
    }
    return end;
}

/// The same text, as long and with the same lines, where comments, literals and preprocessor lines
/// are blank. Literals keep their quotes.
inline std::string code_only(std::string_view text) {
    std::string code(text);
    const auto blank = [&code](size_t begin, size_t end) {
        for (size_t i = begin; i < end && i < code.size(); ++i) {
            if (code[i] != '\n') code[i] = ' ';
        }
    };
    bool line_is_blank = true;
    for (size_t i = 0; i < text.size();) {
        const char c = text[i];
        size_t end = i + 1;
        if (c == '/' && i + 1 < text.size() && (text[i + 1] == '/' || text[i + 1] == '*')) {
            end = comment_end(text, i);
            blank(i, end);
        } else if (c == '#' && line_is_blank) {
            end = directive_end(text, i);
            blank(i, end);
        } else if (c == '"' || (c == '\'' && !is_digit_separator(text, i))) {
            end = literal_end(text, i);
            blank(i + 1, end - 1);
            line_is_blank = false;
        } else if (c == '\n') {
            line_is_blank = true;
        } else if (!is_space(c)) {
            line_is_blank = false;
        }
        i = end;
    }
    return code;
}

/// One #include: "room/file.h" is quoted, <vector> is not.
struct Include {
    std::string path;
    bool quoted = false;
    size_t line = 0;  ///< from 1
};

inline std::vector<Include> find_includes(std::string_view text) {
    std::vector<Include> includes;
    const std::vector<std::string> lines = split_lines(text);
    for (size_t i = 0; i < lines.size(); ++i) {
        std::string_view line = lines[i];
        const auto skip = [&line](std::string_view word) {
            while (!line.empty() && is_space(line.front()))
                line.remove_prefix(1);
            if (line.substr(0, word.size()) != word) return false;
            line.remove_prefix(word.size());
            return true;
        };
        if (!skip("#") || !skip("include") || !skip("")) continue;
        const bool quoted = line.substr(0, 1) == "\"";
        if (!quoted && line.substr(0, 1) != "<") continue;
        const size_t end = line.find(quoted ? '"' : '>', 1);
        if (end == std::string_view::npos) continue;
        includes.push_back({std::string(line.substr(1, end - 1)), quoted, i + 1});
    }
    return includes;
}

/// A function at namespace or class level; lines from 1, from its first line to its last brace.
struct Function {
    std::string name;
    size_t first_line = 0;
    size_t last_line = 0;
    size_t parameters = 0;
    size_t lines() const { return last_line - first_line + 1; }
};

struct FunctionList {
    std::vector<Function> functions;
    bool balanced = true;  ///< false: braces do not match, nothing can be said about lengths
};

/// Walks over code_only() text. Everything before an opening brace, back to the last `;`, `{` or
/// `}`, is its head; the head decides what the brace opens.
class FunctionFinder {
public:
    explicit FunctionFinder(const std::string& code) : code_(code) {}

    FunctionList find() {
        FunctionList list;
        while (at_ < code_.size()) {
            const char c = code_[at_];
            if (c == '(') ++parens_;
            if (c == ')') --parens_;
            if (c == ';' && parens_ == 0) {
                start_head();
            } else if (c == '}') {
                if (scopes_ == 0) list.balanced = false;
                scopes_ -= scopes_ > 0 ? 1 : 0;
                start_head();
            } else if (c == '{') {
                open_brace(list);
            } else {
                head_ += c;
                ++at_;
            }
        }
        list.balanced = list.balanced && scopes_ == 0 && parens_ == 0;
        return list;
    }

private:
    void start_head() {
        head_.clear();
        parens_ = 0;
        head_begin_ = ++at_;
    }

    void open_brace(FunctionList& list) {
        const std::string head = plain_head();
        if (parens_ > 0 || is_initializer(head)) {
            skip_braces(list);
            head_ += "{}";
            return;
        }
        if (head.find('(') == std::string::npos || is_type(head)) {
            ++scopes_;
            start_head();
            return;
        }
        Function function;
        function.name = head.substr(0, head.find('('));
        function.parameters = parameter_count(head);
        function.first_line = line_of(first_code());
        skip_braces(list);
        function.last_line = line_of(at_ - 1);
        list.functions.push_back(function);
        --at_;
        start_head();
    }

    /// The head in one line, without attributes, access specifiers and template parameters.
    std::string plain_head() const {
        std::string head = head_;
        for (const std::string_view word : {"public:", "protected:", "private:"}) {
            const size_t found = head.rfind(word);
            if (found != std::string::npos) head.erase(0, found + word.size());
        }
        erase_group(head, "alignas", '(', ')');
        erase_group(head, "__attribute__", '(', ')');
        erase_group(head, "[[", '[', ']');
        erase_group(head, "template", '<', '>');
        std::string line;
        for (const char c : head) {
            if (!is_space(c)) {
                line += c;
            } else if (!line.empty() && line.back() != ' ') {
                line += ' ';
            }
        }
        while (!line.empty() && line.back() == ' ')
            line.pop_back();
        return line;
    }

    /// Removes every `word` with the bracketed group that follows it.
    static void erase_group(std::string& head, std::string_view word, char open, char close) {
        size_t begin = head.find(word);
        while (begin != std::string::npos) {
            size_t end = head.find(open, begin);
            if (end == std::string::npos) return;
            int depth = 0;
            do {
                depth += head[end] == open ? 1 : head[end] == close ? -1 : 0;
                ++end;
            } while (depth > 0 && end < head.size());
            head.erase(begin, end - begin);
            begin = head.find(word, begin);
        }
    }

    /// `x = {`, `member_{` in a constructor's list, `Type name{`: values, not a body.
    static bool is_initializer(const std::string& head) {
        if (head.empty()) return false;
        const char last = head.back();
        if (last == '=' || last == ',') return true;
        if (last == ')' || last == '}') return false;
        const size_t close = head.find(')');
        if (close == std::string::npos) return false;
        size_t colon = head.find(':', close);
        while (colon != std::string::npos && head.substr(colon, 2) == "::") {
            colon = head.find(':', colon + 2);
        }
        return colon != std::string::npos;
    }

    static bool is_type(const std::string& head) {
        for (const std::string_view word : {"class ", "struct ", "union ", "enum ", "namespace "}) {
            if (head.starts_with(word) || head.starts_with(join({" ", word}))) return true;
        }
        return false;
    }

    /// Commas of the first parenthesised list (of a call operator: the second) that are not inside
    /// other brackets, and one more.
    static size_t parameter_count(const std::string& head) {
        size_t at = head.find('(');
        if (head.substr(0, at).ends_with("operator") && head.compare(at, 2, "()") == 0)
            at = head.find('(', at + 1);
        int depth = 0;
        bool any = false;
        size_t commas = 0;
        for (; at < head.size(); ++at) {
            const char c = head[at];
            any = any || (depth > 0 && c != ')' && !is_space(c));
            commas += c == ',' && depth == 1 ? 1 : 0;
            const bool arrow = c == '>' && at > 0 && head[at - 1] == '-';
            if (std::string_view("([{<").find(c) != std::string_view::npos) ++depth;
            if (std::string_view(")]}>").find(c) != std::string_view::npos && !arrow) --depth;
            if (depth == 0) break;
        }
        return any ? commas + 1 : 0;
    }

    /// Moves behind the brace that closes the one at `at_`.
    void skip_braces(FunctionList& list) {
        int depth = 0;
        do {
            depth += code_[at_] == '{' ? 1 : code_[at_] == '}' ? -1 : 0;
            ++at_;
        } while (depth > 0 && at_ < code_.size());
        if (depth > 0) list.balanced = false;
    }

    /// Where the head's first word is.
    size_t first_code() const {
        size_t i = head_begin_;
        while (i < at_ && is_space(code_[i]))
            ++i;
        return i;
    }

    size_t line_of(size_t at) const {
        const auto end = code_.begin() + static_cast<std::ptrdiff_t>(at);
        return static_cast<size_t>(std::count(code_.begin(), end, '\n')) + 1;
    }

    const std::string& code_;
    std::string head_;
    size_t at_ = 0;
    size_t head_begin_ = 0;
    int parens_ = 0;
    int scopes_ = 0;
};

inline FunctionList find_functions(std::string_view text) {
    const std::string code = code_only(text);
    return FunctionFinder(code).find();
}

}  // namespace obscura::layout
