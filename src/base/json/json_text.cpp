// base/json/json_text.cpp - parses JSON text with limits, and with positions in errors.
// SPDX-License-Identifier: Apache-2.0
#include "base/json/json_text.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace obscura {

namespace {

using nlohmann::json;

/// Builds the tree from the parser's events, with its own stack of open containers instead of
/// recursion.
class TreeBuilder {
public:
    bool null() { return add(json()); }
    bool boolean(bool value) { return add(json(value)); }
    bool number_integer(json::number_integer_t value) { return add(json(value)); }
    bool number_unsigned(json::number_unsigned_t value) { return add(json(value)); }
    bool number_float(json::number_float_t value, const std::string&) { return add(json(value)); }
    bool string(std::string& value) { return add(json(std::move(value))); }
    bool binary(json::binary_t&) { return false; }
    bool start_object(size_t) { return open(json::object()); }
    bool start_array(size_t) { return open(json::array()); }
    bool end_object() { return close(); }
    bool end_array() { return close(); }

    bool key(std::string& name) {
        const size_t before = open_.back()->size();
        member_ = &(*open_.back())[name];
        if (open_.back()->size() == before && repeated_keys.size() < 8) {
            repeated_keys.push_back(name);
        }
        return true;
    }

    bool parse_error(size_t position, const std::string& token, const json::exception& cause) {
        error_position = position;
        error_token = token;
        number_too_large = cause.id == 406;
        return false;
    }

    json root;
    std::vector<std::string> repeated_keys;
    std::optional<size_t> error_position;
    std::string error_token;
    bool number_too_large = false;
    bool too_deep = false;

private:
    json* place(json&& value) {
        if (open_.empty()) {
            root = std::move(value);
            return &root;
        }
        if (open_.back()->is_array()) {
            open_.back()->push_back(std::move(value));
            return &open_.back()->back();
        }
        *member_ = std::move(value);
        return member_;
    }

    bool add(json&& value) {
        place(std::move(value));
        return true;
    }

    bool open(json&& container) {
        too_deep = open_.size() >= static_cast<size_t>(max_json_depth);
        if (!too_deep) open_.push_back(place(std::move(container)));
        return !too_deep;
    }

    bool close() {
        open_.pop_back();
        return true;
    }

    std::vector<json*> open_;
    json* member_ = nullptr;
};

/// "line 3, column 14" of a byte, counted from 1.
std::string line_and_column(std::string_view text, size_t position) {
    const std::string_view before = text.substr(0, std::min(position, text.size()));
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const size_t newline = before.rfind('\n');
    const size_t column =
        newline == std::string_view::npos ? before.size() : before.size() - newline - 1;
    return "line " + std::to_string(line) + ", column " +
           std::to_string(std::max<size_t>(column, 1));
}

tl::unexpected<Error> syntax_error(std::string_view text,
                                   const TreeBuilder& tree,
                                   const std::string& where) {
    std::string what = "this is not valid JSON";
    if (tree.number_too_large) {
        what = "a number is too large for double precision";
    } else if (*tree.error_position > text.size() || tree.error_token.empty()) {
        what = "the JSON text ends too early";
    } else {
        // The token repeats what was read since the last good one; its end is what matters.
        const std::string& token = tree.error_token;
        const size_t kept = std::min<size_t>(token.size(), 32);
        what += " near \"" + token.substr(token.size() - kept) + "\"";
    }
    return fail(ExitCode::bad_data,
                "E-JSON-SYNTAX",
                where,
                line_and_column(text, *tree.error_position) + ": " + what);
}

}  // namespace

Result<nlohmann::json> parse_json_text(std::string_view text, const std::string& where, Log& log) {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (text.substr(0, 3) == byte_order_mark) {
        log.warn(where, "the JSON text starts with a byte order mark, which glTF forbids");
        text.remove_prefix(3);
    }
    TreeBuilder tree;
    const bool complete = json::sax_parse(text.begin(), text.end(), &tree);
    if (tree.too_deep) {
        return fail(
            ExitCode::bad_data,
            "E-JSON-DEPTH",
            where,
            "the JSON text is nested deeper than " + std::to_string(max_json_depth) + " levels");
    }
    if (!complete && tree.error_position) return syntax_error(text, tree, where);
    if (!complete || !tree.root.is_object()) {
        return fail(
            ExitCode::bad_data, "E-JSON-ROOT", where, "the JSON text is not an object, {...}");
    }
    for (const std::string& key : tree.repeated_keys) {
        log.warn(where, "the key \"" + key + "\" occurs twice in one object; the last one counts");
    }
    return std::move(tree.root);
}

}  // namespace obscura
