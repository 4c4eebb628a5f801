// app/json_options.cpp - options as JSON has them.
// SPDX-License-Identifier: Apache-2.0
#include "app/json_options.h"

#include <algorithm>
#include <optional>

namespace obscura::app {

namespace {

using nlohmann::json;

/// A value as the text of an option; nothing: it is of no such type.
std::optional<std::string> text_of(const json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number() || value.is_boolean()) return value.dump();
    return {};
}

/// The texts of a value that may be several.
std::optional<std::vector<std::string>> texts_of(const json& value) {
    std::vector<std::string> out;
    if (!value.is_array()) {
        const auto text = text_of(value);
        if (!text) return {};
        return std::vector<std::string>{*text};
    }
    for (const json& one : value) {
        const auto text = text_of(one);
        if (!text) return {};
        out.push_back(*text);
    }
    return out;
}

/// With commas between them.
std::string joined(const std::vector<std::string>& texts) {
    std::string out;
    for (const std::string& text : texts)
        out += (out.empty() ? "" : ",") + text;
    return out;
}

/// An option with its value: in one word where the value looks like an option.
void add_words(const std::string& name, const std::string& value, std::vector<std::string>& out) {
    if (value.starts_with('-')) {
        out.push_back(name + "=" + value);
    } else {
        out.insert(out.end(), {name, value});
    }
}

}  // namespace

const BoundOption* find_option(const std::vector<BoundOption>& table, const std::string& name) {
    const auto found = std::find_if(table.begin(), table.end(), [&](const BoundOption& one) {
        return long_name(one.info) == name;
    });
    return found == table.end() ? nullptr : &*found;
}

std::string set_from_json(const BoundOption& option, const json& value) {
    const std::optional<std::vector<std::string>> texts = texts_of(value);
    if (!texts) return "expected a string, a number, true, false, or an array of these";
    if (auto* const* flag = std::get_if<bool*>(&option.target)) {
        if (!value.is_boolean()) return "expected true or false";
        **flag = value.get<bool>();
    } else if (auto* const* list = std::get_if<std::vector<std::string>*>(&option.target)) {
        **list = *texts;
    } else if (auto* const* target = std::get_if<OptionText*>(&option.target)) {
        **target = joined(*texts);
    }
    return "";
}

std::vector<std::string> words_from_json(const BoundOption& option, const json& value) {
    const std::string name = long_name(option.info);
    if (std::holds_alternative<bool*>(option.target))
        return value == true ? std::vector<std::string>{name} : std::vector<std::string>();
    const std::vector<std::string> texts = texts_of(value).value_or(std::vector<std::string>());
    std::vector<std::string> out;
    if (std::holds_alternative<std::vector<std::string>*>(option.target)) {
        for (const std::string& text : texts)
            add_words(name, text, out);
    } else {
        add_words(name, joined(texts), out);
    }
    return out;
}

}  // namespace obscura::app
