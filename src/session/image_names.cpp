// session/image_names.cpp - names of images' files by patterns.
// SPDX-License-Identifier: Apache-2.0
#include "session/image_names.h"

#include "session/frames.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>

namespace obscura {

namespace {

constexpr std::array<std::string_view, 5> field_names = {
    "asset", "look", "variant", "view", "frame"};
constexpr int max_digits = 12;

/// A field of a pattern, between braces.
struct Field {
    std::string_view name;
    int digits = 0;  ///< of a frame
};

/// The field that the text between two braces is; nothing: it is none.
std::optional<Field> field_of(std::string_view text) {
    const size_t colon = text.find(':');
    Field out{text.substr(0, colon), 0};
    bool is_known = false;
    for (const std::string_view name : field_names)
        is_known = is_known || name == out.name;
    if (!is_known) return {};
    if (colon == std::string_view::npos) return out;
    const std::string_view digits = text.substr(colon + 1);
    const char* const end = digits.data() + digits.size();
    const auto [stop, error] = std::from_chars(digits.data(), end, out.digits);
    const bool is_number = error == std::errc() && stop == end && out.digits >= 0;
    if (!is_number || out.digits > max_digits || out.name != "frame") return {};
    return out;
}

std::string frame_text(int frame, int digits) {
    std::string out = std::to_string(frame);
    if (out.size() < static_cast<size_t>(digits))
        out.insert(0, static_cast<size_t>(digits) - out.size(), '0');
    return out;
}

std::string value_of(const Field& field, const NameFields& values) {
    if (field.name == "asset") return name_part(values.asset);
    if (field.name == "look") return name_part(values.look);
    if (field.name == "variant") return name_part(values.variant);
    if (field.name == "view") return name_part(values.view);
    return frame_text(values.frame, field.digits);
}

/// Calls `text` with what lies between fields, and `use` with each field.
template <typename Text, typename Use>
void each_field(std::string_view pattern, const Text& text, const Use& use) {
    while (!pattern.empty()) {
        const size_t open = pattern.find('{');
        text(pattern.substr(0, open));
        if (open == std::string_view::npos) return;
        pattern.remove_prefix(open);
        const size_t close = pattern.find('}');
        const std::optional<Field> field =
            close == std::string_view::npos ? std::nullopt : field_of(pattern.substr(1, close - 1));
        if (field) {
            use(*field);
        } else {
            text("{");
        }
        pattern.remove_prefix(field ? close + 1 : 1);
    }
}

}  // namespace

bool has_field(const std::filesystem::path& pattern, std::string_view field) {
    bool found = false;
    each_field(
        pattern.string(),
        [](std::string_view) {},
        [&](const Field& one) { found = found || one.name == field; });
    return found;
}

bool has_fields(const std::filesystem::path& pattern) {
    bool found = false;
    for (const std::string_view name : field_names)
        found = found || has_field(pattern, name);
    return found;
}

std::filesystem::path name_by_pattern(const std::filesystem::path& pattern,
                                      const NameFields& fields) {
    std::string out;
    each_field(
        pattern.string(),
        [&](std::string_view text) { out += text; },
        [&](const Field& field) { out += value_of(field, fields); });
    return out;
}

std::filesystem::path numbered_file(const std::filesystem::path& pattern, int frame) {
    NameFields fields;
    fields.frame = frame;
    return name_by_pattern(frame_file(pattern, frame).value_or(pattern), fields);
}

NameShape::NameShape(const std::filesystem::path& pattern, const NameFields& fields) : parts_(1) {
    const auto add = [&](std::string_view text) {
        for (const char c : text) {
            Part& part = parts_.back();
            if (c == '/') {
                parts_.emplace_back();
            } else if (c == '#') {  // digits of a frame
                part.is_open = true;
                part.end.clear();
            } else {
                (part.is_open ? part.end : part.begin) += c;
            }
        }
    };
    each_field(pattern.lexically_normal().string(), add, [&](const Field& field) {
        const bool is_known = field.name == "asset" || field.name == "look";
        add(is_known ? value_of(field, fields) : "#");
    });
}

bool NameShape::may_equal(const Part& a, const Part& b) {
    const size_t begin = std::min(a.begin.size(), b.begin.size());
    const size_t end = std::min(a.end.size(), b.end.size());
    if (a.is_open && b.is_open) {
        return a.begin.compare(0, begin, b.begin, 0, begin) == 0 &&
               a.end.compare(a.end.size() - end, end, b.end, b.end.size() - end, end) == 0;
    }
    if (!a.is_open && !b.is_open) return a.begin == b.begin;
    const Part& open = a.is_open ? a : b;
    const std::string& whole = a.is_open ? b.begin : a.begin;
    return whole.size() > open.begin.size() + open.end.size() && whole.starts_with(open.begin) &&
           whole.ends_with(open.end);
}

bool NameShape::may_equal(const NameShape& other) const {
    return std::equal(parts_.begin(),
                      parts_.end(),
                      other.parts_.begin(),
                      other.parts_.end(),
                      [](const Part& a, const Part& b) { return may_equal(a, b); });
}

std::string name_part(std::string_view text) {
    constexpr std::string_view refused = "/\\\"*:<>?|{}";
    std::string out(text);
    for (char& c : out) {
        const auto code = static_cast<unsigned char>(c);
        if (code < 0x20 || code == 0x7F || refused.find(c) != std::string_view::npos) c = '_';
    }
    if (!out.empty() && out.front() == '.') out.front() = '_';
    return out.empty() ? "_" : out;
}

}  // namespace obscura
