// image/ies_file.cpp - reads IES LM-63 photometric files.
// SPDX-License-Identifier: Apache-2.0
#include "image/ies_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

namespace obscura {

namespace {

enum class Photometry { c = 1, b = 2, a = 3 };  // the file's numbers

/// Limits of plausible factors and intensities; products stay finite in single precision.
constexpr double largest_factor = 1e9;
constexpr double largest_candela = 1e12;

/// Reads numbers separated by blanks and commas, and counts lines.
struct NumberReader {
    std::string_view rest;
    std::string where;
    int line = 1;

    tl::unexpected<Error> bad(const char* id, const std::string& message) const {
        return fail(ExitCode::bad_data, id, where, "line " + std::to_string(line) + ": " + message);
    }

    void skip_blanks() {
        constexpr std::string_view blanks(" \t\r\n\f\v,");
        const size_t length = std::min(rest.find_first_not_of(blanks), rest.size());
        const std::string_view skipped = rest.substr(0, length);
        line += static_cast<int>(std::count(skipped.begin(), skipped.end(), '\n'));
        rest.remove_prefix(length);
    }

    /// Description of a number, for messages, and its range.
    struct Wanted {
        const char* what;
        double low;
        double high;
    };

    Result<double> number(const Wanted& wanted) {
        skip_blanks();
        if (rest.empty()) {
            return bad("E-IES-SHORT", std::string("the file ends before the ") + wanted.what);
        }
        const size_t length = std::min(rest.find_first_of(" \t\r\n\f\v,"), rest.size());
        const std::string_view word = rest.substr(0, length);
        const size_t sign = word.front() == '+' ? 1 : 0;
        double value = 0;
        const auto [end, error] =
            std::from_chars(word.data() + sign, word.data() + word.size(), value);
        if (error != std::errc() || end != word.data() + word.size() ||
            !(value >= wanted.low && value <= wanted.high)) {
            std::string shown;
            for (const char c : word.substr(0, 20))
                shown += c >= ' ' && c <= '~' ? c : '?';
            return bad("E-IES-NUMBER",
                       "\"" + shown + "\" is read as the " + wanted.what +
                           "; accepted are numbers from " + text(wanted.low) + " to " +
                           text(wanted.high));
        }
        rest.remove_prefix(length);
        return value;
    }

    static std::string text(double value) {
        char digits[32];
        const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
        return {digits, end};
    }

    Result<std::vector<double>> numbers(size_t count, const Wanted& wanted) {
        std::vector<double> out;
        out.reserve(count);
        for (size_t i = 0; i < count; ++i) {
            const Result<double> value = number(wanted);
            if (!value) return fail(value.error());
            out.push_back(*value);
        }
        return out;
    }
};

/// The data between TILT and the angles.
struct Header {
    double candela_factor = 1;
    size_t polar_count = 0;
    size_t plane_count = 0;
    Photometry type = Photometry::c;
};

/// Moves the reader behind the line that begins with TILT=.
///
/// Out     the text after the equals sign
Result<std::string_view> find_tilt(NumberReader& reader) {
    constexpr std::string_view key = "TILT=";
    while (!reader.rest.empty()) {
        const size_t length = std::min(reader.rest.find_first_of("\r\n"), reader.rest.size());
        const std::string_view line = reader.rest.substr(0, length);
        reader.rest.remove_prefix(length);
        const size_t begin = std::min(line.find_first_not_of(" \t"), line.size());
        if (line.substr(begin, key.size()) == key) {
            std::string_view value = line.substr(begin + key.size());
            value = value.substr(0, value.find_first_of(" \t"));
            return value;
        }
        if (reader.rest.substr(0, 2) == "\r\n") reader.rest.remove_prefix(1);
        if (!reader.rest.empty()) reader.rest.remove_prefix(1);
        ++reader.line;
    }
    return fail(ExitCode::bad_data,
                "E-IES-FORMAT",
                reader.where,
                "no line begins with TILT=; accepted are photometric files by IES LM-63");
}

/// TILT=INCLUDE is followed by a geometry, a count, and as many angles and factors.
Result<void> skip_tilt(NumberReader& reader) {
    const Result<double> geometry = reader.number({"lamp-to-luminaire geometry", 0, 100});
    if (!geometry) return fail(geometry.error());
    const Result<double> pairs =
        reader.number({"number of tilt angles", 0, static_cast<double>(reader.rest.size())});
    if (!pairs) return fail(pairs.error());
    const auto count = 2 * static_cast<size_t>(*pairs);
    const auto skipped = reader.numbers(count, {"tilt angle or factor", -1e6, 1e6});
    return skipped ? Result<void>{} : fail(skipped.error());
}

/// In      old: editions 1986 and 1991, where the second number after the sizes is a factor
Result<Header> read_header(NumberReader& reader, bool old) {
    // A number needs a digit and a blank, so the rest of the file bounds how many there are.
    const auto most = static_cast<double>(reader.rest.size());
    const NumberReader::Wanted wanted[] = {{"number of lamps", -1e6, 1e6},
                                           {"lumens per lamp", -1e12, 1e12},
                                           {"candela multiplier", 0, largest_factor},
                                           {"number of vertical angles", 2, most},
                                           {"number of horizontal angles", 1, most},
                                           {"photometric type", 1, 3},
                                           {"units type", 0, 100},
                                           {"luminaire's width", -1e6, 1e6},
                                           {"luminaire's length", -1e6, 1e6},
                                           {"luminaire's height", -1e6, 1e6},
                                           {"ballast factor", 0, largest_factor},
                                           {"ballast-lamp factor or file type", 0, largest_factor},
                                           {"input watts", -1e12, 1e12}};
    double values[std::size(wanted)] = {};
    for (size_t i = 0; i < std::size(wanted); ++i) {
        const Result<double> value = reader.number(wanted[i]);
        if (!value) return fail(value.error());
        values[i] = *value;
        const bool whole = i >= 3 && i <= 5;
        if (whole && values[i] != std::floor(values[i])) {
            return reader.bad("E-IES-NUMBER",
                              std::string("the ") + wanted[i].what + " is not a whole number");
        }
    }
    Header out;
    out.candela_factor = values[2] * values[10] * (old ? values[11] : 1.0);
    out.polar_count = static_cast<size_t>(values[3]);
    out.plane_count = static_cast<size_t>(values[4]);
    out.type = static_cast<Photometry>(static_cast<int>(values[5]));
    if (out.polar_count * out.plane_count > reader.rest.size()) {
        return reader.bad("E-IES-SHORT",
                          "the file ends before the candela values of " +
                              std::to_string(out.polar_count) + " x " +
                              std::to_string(out.plane_count) + " angles");
    }
    return out;
}

/// The planes stored in a file: angles in degrees, candela[plane][angle].
struct Planes {
    std::vector<double> angles;  ///< within a plane: "vertical"
    std::vector<double> places;  ///< of the planes: "horizontal"
    std::vector<std::vector<double>> candela;
};

/// Whether angles rise strictly in single precision, the table's type.
bool rises(const std::vector<double>& angles) {
    const auto stays = [](double a, double b) {
        return static_cast<float>(a) >= static_cast<float>(b);
    };
    return std::adjacent_find(angles.begin(), angles.end(), stays) == angles.end();
}

Result<Planes> read_planes(NumberReader& reader, const Header& header) {
    const bool c = header.type == Photometry::c;
    Planes out;
    auto angles =
        reader.numbers(header.polar_count, {"vertical angle", c ? 0.0 : -90.0, c ? 180.0 : 90.0});
    if (!angles) return fail(angles.error());
    if (!rises(*angles)) return reader.bad("E-IES-ANGLES", "the vertical angles do not rise");
    auto places = reader.numbers(header.plane_count,
                                 {"horizontal angle", c ? 0.0 : -180.0, c ? 360.0 : 180.0});
    if (!places) return fail(places.error());
    if (!rises(*places)) return reader.bad("E-IES-ANGLES", "the horizontal angles do not rise");
    out.angles = std::move(*angles);
    out.places = std::move(*places);
    for (size_t plane = 0; plane < header.plane_count; ++plane) {
        auto candela = reader.numbers(header.polar_count, {"candela value", 0, largest_candela});
        if (!candela) return fail(candela.error());
        for (double& value : *candela)
            value = std::min(value * header.candela_factor, largest_candela);
        out.candela.push_back(std::move(*candela));
    }
    return out;
}

/// Appends the mirror images of all planes; the last plane is the mirror.
void mirror_behind(Planes& planes) {
    const double mirror = planes.places.back();
    for (size_t i = planes.places.size() - 1; i-- > 0;) {
        planes.places.push_back(2.0 * mirror - planes.places[i]);
        planes.candela.push_back(planes.candela[i]);
    }
}

/// Prepends the mirror images of the planes above 0.
void mirror_before_zero(Planes& planes) {
    const size_t skip = planes.places.front() == 0 ? 1 : 0;
    Planes out;
    for (size_t i = planes.places.size(); i-- > skip;) {
        out.places.push_back(-planes.places[i]);
        out.candela.push_back(planes.candela[i]);
    }
    planes.places.insert(planes.places.begin(), out.places.begin(), out.places.end());
    planes.candela.insert(planes.candela.begin(), out.candela.begin(), out.candela.end());
}

/// The same within every plane.
void mirror_angles(Planes& planes) {
    const std::vector<double> angles = planes.angles;
    const size_t skip = angles.front() == 0 ? 1 : 0;
    const auto extend = [&](std::vector<double>& values, double sign) {
        std::vector<double> out;
        for (size_t i = values.size(); i-- > skip;)
            out.push_back(sign * values[i]);
        values.insert(values.begin(), out.begin(), out.end());
    };
    extend(planes.angles, -1.0);
    for (std::vector<double>& plane : planes.candela)
        extend(plane, 1.0);
}

/// Completes the planes of type C to the full circle.
Result<void> close_circle(const NumberReader& reader, Planes& planes) {
    const double first = planes.places.front();
    const double last = planes.places.back();
    if (planes.places.size() == 1) return {};
    if (first == 0 && last == 90) mirror_behind(planes);
    if ((first == 0 && last == 90) || (first == 0 && last == 180) || (first == 90 && last == 270)) {
        mirror_behind(planes);
        return {};
    }
    if (first == 0 && last == 360) return {};
    if (first == 0 && last > 180) {  // some programs omit the plane at 360, which equals that at 0
        planes.places.push_back(360);
        planes.candela.push_back(planes.candela.front());
        return {};
    }
    return reader.bad("E-IES-ANGLES",
                      "the horizontal angles go from " + NumberReader::text(first) + " to " +
                          NumberReader::text(last) +
                          "; accepted are 0 alone, 0 to 90, 0 to 180, 0 to 360 and 90 to 270");
}

LightProfile profile_of(Planes planes, Photometry type) {
    LightProfile out;
    out.polar_is_aim = type == Photometry::c;
    if (!out.polar_is_aim) {  // angles count from the plane perpendicular to the polar axis
        for (double& angle : planes.angles)
            angle = 90.0 - angle;
        std::reverse(planes.angles.begin(), planes.angles.end());
        for (std::vector<double>& plane : planes.candela)
            std::reverse(plane.begin(), plane.end());
    }
    const auto append = [](const std::vector<double>& from, std::vector<float>& to) {
        for (const double value : from)
            to.push_back(static_cast<float>(value));
    };
    append(planes.angles, out.polar_deg);
    append(planes.places, out.azimuth_deg);
    for (const std::vector<double>& plane : planes.candela)
        append(plane, out.candela);
    return out;
}

/// True for the editions of 1986, which has no line with its name, and of 1991 ("IESNA91").
bool is_before_1995(std::string_view text) {
    const std::string_view first = text.substr(0, text.find_first_of("\r\n"));
    return first.substr(0, 3) != "IES" || first.find("86") != std::string_view::npos ||
           first.find("91") != std::string_view::npos;
}

}  // namespace

Result<LightProfile> read_ies(std::span<const std::byte> bytes, const std::string& where) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    NumberReader reader{text, where};
    const Result<std::string_view> tilt = find_tilt(reader);
    if (!tilt) return fail(tilt.error());
    if (*tilt == "INCLUDE") {
        const Result<void> skipped = skip_tilt(reader);
        if (!skipped) return fail(skipped.error());
    }
    const Result<Header> header = read_header(reader, is_before_1995(text));
    if (!header) return fail(header.error());
    Result<Planes> planes = read_planes(reader, *header);
    if (!planes) return fail(planes.error());
    if (header->type == Photometry::c) {
        const Result<void> closed = close_circle(reader, *planes);
        if (!closed) return fail(closed.error());
    } else {
        if (planes->places.front() >= 0) mirror_before_zero(*planes);
        if (planes->angles.front() >= 0) mirror_angles(*planes);
    }
    return profile_of(std::move(*planes), header->type);
}

}  // namespace obscura
