// base/json_writer.h - writes JSON text piece by piece: for statistics and reports.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace obscura {

/// Builds one JSON document, indented by two spaces, with commas and escapes where they belong.
///
/// Calls must nest like the document: a key before every value in an object, none in an array.
/// The text does not depend on the locale.
class JsonWriter {
public:
    JsonWriter& begin_object();
    JsonWriter& end_object();
    JsonWriter& begin_array();
    JsonWriter& end_array();
    JsonWriter& key(std::string_view name);

    /// Control characters are escaped; bytes that are not UTF-8 become U+FFFD.
    JsonWriter& value(std::string_view text);
    JsonWriter& value(const char* text) { return value(std::string_view(text)); }
    /// Shortest text that reads back as the same number; NaN and infinity become null.
    JsonWriter& value(double number);
    template <typename T>
    requires std::same_as<T, bool> JsonWriter& value(T truth) {
        return raw_value(truth ? "true" : "false");
    }
    template <typename T>
    requires(std::integral<T> && !std::same_as<T, bool>) JsonWriter& value(T number) {
        return raw_value(std::to_string(number));
    }

    template <typename T>
    JsonWriter& member(std::string_view name, const T& content) {
        return key(name).value(content);
    }

    /// The document and a line feed; everything opened has been closed.
    std::string take() &&;

private:
    JsonWriter& raw_value(std::string_view text);
    JsonWriter& open(char bracket);
    JsonWriter& close(char bracket);
    void start_item();
    void new_line();

    std::string text_;
    std::vector<bool> has_items_;  ///< one a level that is open
    bool after_key_ = false;
};

}  // namespace obscura
