// session/image_names.h - names of images' files by patterns: {asset}, {look}, {view} and the like.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace obscura {

/// What the fields of a pattern stand for in the name of one image.
struct NameFields {
    std::string asset, variant, view;
    int frame = 1;
    std::string look = "default";
};

/// True when a pattern has the field: "frame" is there as {frame} and as {frame:04}.
bool has_field(const std::filesystem::path& pattern, std::string_view field);

/// True when a pattern has any field.
bool has_fields(const std::filesystem::path& pattern);

/// The pattern with its fields replaced, {frame:04} by the number with zeros in front up to four
/// digits. Texts become parts of names: see name_part. All else stays.
std::filesystem::path name_by_pattern(const std::filesystem::path& pattern,
                                      const NameFields& fields);

/// The file of a frame: the number in place of # or {frame}, as by frame_file and name_by_pattern.
std::filesystem::path numbered_file(const std::filesystem::path& pattern, int frame);

/// What is settled of the names that a pattern gives, while only asset and look are known.
class NameShape {
public:
    /// In      fields: asset and look; the others are not looked at
    NameShape(const std::filesystem::path& pattern, const NameFields& fields);
    /// Whether both patterns may give one name. It is true too often rather than too seldom.
    bool may_equal(const NameShape& other) const;

private:
    /// One part of a path: what its name begins and ends with; all of it where nothing is open.
    struct Part {
        std::string begin, end;
        bool is_open = false;
    };
    static bool may_equal(const Part& a, const Part& b);

    std::vector<Part> parts_;
};

/// A text as a part of a file's name: what file systems or shells take for something else (slashes,
/// control characters, " * : < > ? | { }) becomes _, and so does a dot in front.
std::string name_part(std::string_view text);

}  // namespace obscura
