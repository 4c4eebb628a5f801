// film/light_path_expression.cpp - light path expressions: from their text to a syntax tree.
// SPDX-License-Identifier: Apache-2.0
#include "film/light_path_expression.h"

#include "base/text.h"
#include "film/path_order.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace obscura {

namespace {

using Kind = PathNode::Kind;

/// The letters of one position in <...>, and what a message says about it.
struct Position {
    std::string_view letters;
    std::string_view accepted;
    std::string_view in_set;  ///< accepted between "[" and "]"
};

constexpr Position types{.letters = "RTVLOB",
                         .accepted = "a type (R, T, V, L, O, B), '.' or a set such as [RT]",
                         .in_set = "one or more of R, T, V, L, O, B, and then ']'"};

constexpr Position modes{
    .letters = "DGS-",
    .accepted = "a mode (D, G, S), '.', a set such as [GS], a label in quotes or '>'",
    .in_set = "one or more of D, G, S, and then ']'"};
static_assert(modes.letters.back() == no_mode);

bool has(std::string_view letters, char letter) {
    return letter != '\0' && letters.find(letter) != std::string_view::npos;
}

/// True for what may be written: lights have no letter for their mode.
bool is_letter_of(const Position& position, char c) {
    return has(position.letters, c) && c != no_mode;
}

bool is_space(char c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
}

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

/// True when all of `text` matches `glob`. Only the last "*" that was met is tried with more text:
/// whatever an earlier one could pass over in addition, this one can pass over as well.
bool matches_glob(std::string_view glob, std::string_view text) {
    constexpr size_t nowhere = std::string_view::npos;
    size_t g = 0;
    size_t t = 0;
    size_t star = nowhere;
    size_t retry = 0;
    while (t < text.size()) {
        if (g < glob.size() && glob[g] == '*') {
            star = g++;
            retry = t;
        } else if (g < glob.size() && glob[g] == text[t]) {
            ++g;
            ++t;
        } else if (star != nowhere) {
            g = star + 1;
            t = ++retry;
        } else {
            return false;
        }
    }
    return glob.find_first_not_of('*', g) == nowhere;
}

bool matches(const LabelPattern& labels, std::string_view label) {
    const bool listed =
        std::any_of(labels.globs.begin(), labels.globs.end(), [&](const std::string& glob) {
            return matches_glob(glob, label);
        });
    return listed != labels.negated;
}

bool matches(const EventSet& events, char type, char mode, std::string_view label) {
    const bool listed =
        std::any_of(events.members.begin(), events.members.end(), [&](const EventPattern& pattern) {
            return has(pattern.types, type) && has(pattern.modes, mode) &&
                   matches(pattern.labels, label);
        });
    return listed != events.negated;
}

/// Recursive descent. At the first fault the rest of the text is skipped, so that every function
/// comes to its end, and the fault is kept.
class Parser {
public:
    explicit Parser(std::string_view text) : text_(text) {}

    Result<LightPathExpression> parse() {
        if (text_.size() > max_expression_length) {
            refuse(max_expression_length + 1,
                   "the expression is longer than the accepted " +
                       std::to_string(max_expression_length) + " bytes");
        }
        choice();
        if (peek() != '\0' || position_ < text_.size()) refuse_here("an event or an operator");
        if (!error_) {
            if (const std::optional<PathOrderFault> fault = find_path_order_fault(nodes_))
                refuse(fault->column, fault->message);
        }
        if (error_) return fail(std::move(*error_));
        return LightPathExpression{std::string(text_), std::move(nodes_)};
    }

private:
    /// The next character that is no white space; 0 at the end.
    char peek() {
        while (position_ < text_.size() && is_space(text_[position_]))
            ++position_;
        return position_ < text_.size() ? text_[position_] : '\0';
    }

    size_t column() {
        peek();
        return position_ + 1;
    }

    bool take(char wanted) {
        if (peek() != wanted) return false;
        ++position_;
        return true;
    }

    void expect(char wanted, const std::string& accepted) {
        if (!take(wanted)) refuse_here(accepted);
    }

    /// In      column: from 1; 0 when it is about the expression as a whole
    void refuse(size_t column, const std::string& message) {
        if (!error_) {
            const std::string place = column == 0 ? "" : "column " + std::to_string(column) + ": ";
            std::string where(text_.substr(0, max_shown_expression));
            error_ = Error{ExitCode::usage, "E-LPE", std::move(where), place + message};
        }
        position_ = text_.size();
    }

    /// What is found at the current position, for messages.
    std::string found() {
        const char c = peek();
        if (position_ == text_.size()) return "the end of the expression";
        if (c < ' ' || c > '~') return "a character that is not printable ASCII";
        return in_quotes(std::string_view(&c, 1));
    }

    void refuse_here(std::string_view accepted) {
        const size_t at = column();
        refuse(at, found() + " is not accepted here, but " + std::string(accepted));
    }

    void refuse_event(std::string_view events) {
        const size_t at = column();
        refuse(at, found() + " is no event; " + std::string(events));
    }

    size_t add(PathNode node) {
        nodes_.push_back(std::move(node));
        return nodes_.size() - 1;
    }

    /// A node of one child is that child.
    size_t add_group(Kind kind, size_t at, std::vector<size_t> children) {
        if (children.size() == 1) return children[0];
        return add({.kind = kind, .column = at, .children = std::move(children)});
    }

    size_t choice() {
        const size_t at = column();
        std::vector<size_t> children = {sequence()};
        while (take('|'))
            children.push_back(sequence());
        return add_group(Kind::choice, at, std::move(children));
    }

    size_t sequence() {
        const size_t at = column();
        std::vector<size_t> children = {repetition()};
        while (!has("|)", peek()) && peek() != '\0')
            children.push_back(repetition());
        return add_group(Kind::sequence, at, std::move(children));
    }

    size_t repetition() {
        PathNode node{.kind = Kind::repetition, .column = column()};
        node.children = {atom()};
        if (take('*')) {
            node.min_count = 0;
            node.max_count = PathNode::unbounded;
        } else if (take('+')) {
            node.max_count = PathNode::unbounded;
        } else if (take('?')) {
            node.min_count = 0;
        } else if (take('{')) {
            read_counts(node);
        } else {
            return node.children[0];
        }
        if (has("*+?{", peek())) {
            refuse_here("an event, '|', ')' or the end: one operator an event; (X*)? has two");
        }
        return add(std::move(node));
    }

    /// n}, n,m} or n,}
    void read_counts(PathNode& node) {
        node.min_count = count();
        node.max_count = node.min_count;
        if (take(',')) {
            const size_t at = column();
            node.max_count = is_digit(peek()) ? count() : PathNode::unbounded;
            if (node.max_count != PathNode::unbounded && node.max_count < node.min_count)
                refuse(at, "{n,m} is accepted with m not below n only");
        }
        expect('}', "a digit, ',' or '}', as in {2}, {2,4} or {2,}");
    }

    int count() {
        const size_t at = column();
        if (!is_digit(peek())) refuse_here("a number, as in {2}, {2,4} or {2,}");
        int value = 0;
        for (; is_digit(peek()); ++position_)
            value = std::min(10 * value + (text_[position_] - '0'), max_repetition_count + 1);
        if (value > max_repetition_count) {
            refuse(at,
                   "counts from 0 to " + std::to_string(max_repetition_count) + " are accepted");
        }
        return value;
    }

    size_t atom() {
        const size_t at = column();
        if (take('C')) return add({.kind = Kind::camera, .column = at});
        if (!take('(')) return add({.kind = Kind::event, .column = at, .events = event_set()});
        if (++nesting_ > max_expression_nesting) {
            refuse(at,
                   std::to_string(max_expression_nesting) +
                       " parentheses within each other are accepted, no more");
        }
        const size_t inside = choice();
        --nesting_;
        expect(')', "an event, an operator or ')'");
        return inside;
    }

    /// One event, or a set of them in brackets.
    EventSet event_set() {
        EventSet events;
        if (!take('[')) {
            events.members.push_back(event(
                "events are C, R, T, V, D, G, S, L, O, B, '.', <...>, and sets [...] and [^...]"));
            return events;
        }
        events.negated = take('^');
        do {
            events.members.push_back(
                event("events in a set are R, T, V, D, G, S, L, O, B, '.' and <...>; ']' ends it"));
        } while (!take(']') && !error_);
        return events;
    }

    /// In      events: what could be there, for the message
    EventPattern event(std::string_view events) {
        if (take('<')) return event_in_brackets();
        EventPattern pattern{std::string(types.letters), std::string(modes.letters), {}};
        const char letter = peek();
        if (is_letter_of(types, letter)) {
            pattern.types = letter;
        } else if (is_letter_of(modes, letter)) {
            pattern.modes = letter;
        } else if (letter != '.') {
            refuse_event(events);
            return pattern;
        }
        ++position_;
        return pattern;
    }

    /// What follows "<", with the ">".
    EventPattern event_in_brackets() {
        EventPattern pattern{letters(types), std::string(modes.letters), {}};
        const bool is_light = pattern.types.find_first_of("RTV") == std::string::npos;
        if (is_light) {
            take('.');
        } else if (peek() != '>' && !is_label_next()) {
            pattern.modes = letters(modes);
        }
        if (is_label_next()) {
            pattern.labels = label_set();
            expect('>', "'>'");
        } else if (take('.')) {
            expect('>', "'>'");
        } else {
            expect('>',
                   is_light ? "a label in quotes or '>', as a light has no mode"
                            : "a label in quotes or '>'");
        }
        return pattern;
    }

    /// A letter, all of them for ".", or those of a set.
    std::string letters(const Position& position) {
        if (take('.')) return std::string(position.letters);
        if (!take('[')) return std::string(1, letter(position, position.accepted));
        const bool negated = take('^');
        std::string listed;
        do {
            listed += letter(position, position.in_set);
        } while (!take(']') && !error_);
        std::string chosen;
        for (const char candidate : position.letters) {
            if (has(listed, candidate) != negated) chosen += candidate;
        }
        return chosen;
    }

    char letter(const Position& position, std::string_view accepted) {
        const char c = peek();
        if (is_letter_of(position, c)) {
            ++position_;
        } else {
            refuse_here(accepted);
        }
        return c;
    }

    /// True before a label or a set of them.
    bool is_label_next() {
        if (peek() == '\'') return true;
        if (peek() != '[') return false;
        const size_t first = text_.find_first_not_of("[^ \t\n\v\f\r", position_);
        return first != std::string_view::npos && text_[first] == '\'';
    }

    LabelPattern label_set() {
        LabelPattern labels;
        labels.negated = false;
        if (!take('[')) {
            labels.globs.push_back(label());
            return labels;
        }
        labels.negated = take('^');
        do {
            labels.globs.push_back(label());
        } while (!take(']') && !error_);
        return labels;
    }

    std::string label() {
        const size_t at = column();
        if (!take('\'')) {
            refuse_here("a label in quotes; ']' ends a set of them");
            return {};
        }
        const size_t end = text_.find('\'', position_);
        if (end == std::string_view::npos) {
            refuse(at, "the label that begins here has no second quote");
            return {};
        }
        const size_t begin = std::exchange(position_, end + 1);
        return std::string(text_.substr(begin, end - begin));
    }

    std::string_view text_;
    size_t position_ = 0;
    int nesting_ = 0;
    std::vector<PathNode> nodes_;
    std::optional<Error> error_;
};

}  // namespace

bool matches(const EventSet& events, const ScatterEvent& scattering) {
    return matches(events, scattering.type, scattering.mode, scattering.lobe);
}

bool matches(const EventSet& events, const LightEvent& light) {
    return matches(events, light.kind, no_mode, light.group);
}

Result<LightPathExpression> parse_light_path_expression(std::string_view text) {
    return Parser(text).parse();
}

}  // namespace obscura
