// serve/drake.cpp - reads what Drake's render client asks for.
// SPDX-License-Identifier: Apache-2.0
#include "serve/drake.h"

#include "base/log.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

namespace obscura::serve {

namespace {

constexpr int largest_side = 65536;      // as --size has it
constexpr int64_t max_pixels = 1 << 29;  // likewise

tl::unexpected<Error> bad_field(const std::string& name, const std::string& message) {
    return fail(ExitCode::usage, "E-DRAKE-FIELD", name, message);
}

/// Reads fields one after the other; the first fault counts.
class Fields {
public:
    explicit Fields(const Form& form) : form_(form) {}

    std::string text(const std::string& name) {
        const auto field = form_.find(name);
        if (field != form_.end()) return field->second;
        refuse(name, "the field is missing");
        return "";
    }

    double number(const std::string& name, double least, double most) {
        const std::string digits = text(name);
        double value = 0;
        if (!parse(digits, value) || !std::isfinite(value)) {
            refuse(name, "expected a number, not '" + shown(digits) + "'");
        } else if (!(value >= least && value <= most)) {
            refuse(name, "the number is out of range: " + shown(digits));
        }
        return value;
    }
    double positive(const std::string& name) {
        constexpr double least = 1e-9, most = 1e9;
        return number(name, least, most);
    }

    int side(const std::string& name) {
        const std::string digits = text(name);
        int value = 0;
        if (!parse(digits, value) || value < 1 || value > largest_side) {
            refuse(name,
                   "expected a whole number from 1 to " + std::to_string(largest_side) + ", not '" +
                       shown(digits) + "'");
        }
        return value;
    }

    bool has(const std::string& name) const { return form_.contains(name); }
    void refuse(const std::string& name, const std::string& message) {
        if (ok_) ok_ = bad_field(name, message);
    }
    const Result<void>& ok() const { return ok_; }

private:
    template <typename T>
    static bool parse(const std::string& text, T& value) {
        const char* const end = text.data() + text.size();
        const auto [stop, error] = std::from_chars(text.data(), end, value);
        return error == std::errc() && stop == end;
    }
    static std::string shown(const std::string& text) {
        constexpr size_t longest = 40;
        return escape_control(text.substr(0, longest));
    }

    const Form& form_;
    Result<void> ok_;
};

DrakeImage read_image_type(Fields& fields) {
    const std::string name = fields.text("image_type");
    if (name == "depth") return DrakeImage::depth;
    if (name == "label") return DrakeImage::label;
    if (name != "color") fields.refuse("image_type", "expected color, depth or label");
    return DrakeImage::color;
}

std::string read_sha256(Fields& fields) {
    std::string digits = fields.text("scene_sha256");
    std::transform(digits.begin(), digits.end(), digits.begin(), [](char c) {
        return c >= 'A' && c <= 'F' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    constexpr size_t count = 64;
    const bool is_one =
        digits.size() == count && digits.find_first_not_of("0123456789abcdef") == std::string::npos;
    if (!is_one) fields.refuse("scene_sha256", "expected 64 hexadecimal digits");
    return digits;
}

void read_depth_range(Fields& fields, DrakeRequest& out) {
    constexpr double most = 1e9;
    auto& [least, greatest] = out.depth_range_m;
    least = fields.number("min_depth", 0, most);
    greatest = fields.positive("max_depth");
    if (!(least < greatest)) fields.refuse("max_depth", "expected more than min_depth");
}

// clang-format off
/// Options of an image that the form leaves open.
constexpr std::array<std::string_view, 26> option_names = {
    "spp", "noise-target", "spp-min", "depth", "seed", "filter", "denoise", "clamp-direct",
    "clamp-indirect", "caustics", "regularize", "background", "page", "exposure", "view", "display",
    "no-dither", "lenient", "hide", "lights", "catcher", "env", "env-intensity", "env-rotation",
    "point-size", "line-width"};
// clang-format on

tl::unexpected<Error> bad_option(const std::string& name, const std::string& message) {
    return fail(ExitCode::usage, "E-DRAKE-OPTION", escape_control(name), message);
}

/// An option's value as JSON has it: a name alone is a flag.
Options value_of(const std::string& text) {
    if (text.empty() || text == "true") return true;
    if (text == "false") return false;
    return text;
}

std::string listed_options() {
    std::string out;
    for (const std::string_view name : option_names)
        out += std::string(name) + ", ";
    return out + "labels, up and token";
}

}  // namespace

Result<DrakeRequest> read_drake_form(const Form& form) {
    Fields fields(form);
    DrakeRequest out;
    if (!fields.has("scene")) fields.refuse("scene", "the field is missing");
    out.sha256 = read_sha256(fields);
    out.image = read_image_type(fields);
    out.width = fields.side("width");
    out.height = fields.side("height");
    if (int64_t{1} * out.width * out.height > max_pixels)
        fields.refuse("width", "the image has more than 2^29 pixels");
    out.near_m = fields.positive("near");
    out.far_m = fields.positive("far");
    if (!(out.near_m < out.far_m)) fields.refuse("far", "expected more than near");
    Intrinsics& lens = out.intrinsics;
    lens.width_px = out.width;
    lens.height_px = out.height;
    lens.fx_px = fields.positive("focal_x");
    lens.fy_px = fields.positive("focal_y");
    for (const char* angle : {"fov_x", "fov_y"}) {
        if (fields.has(angle)) fields.number(angle, 0, pi_d);
    }
    constexpr double far_away = 1e6;  // pixels
    lens.cx_px = fields.number("center_x", -far_away, far_away);
    lens.cy_px = fields.number("center_y", -far_away, far_away);
    if (out.image == DrakeImage::depth) read_depth_range(fields, out);
    if (!fields.ok()) return fail(fields.ok().error());
    return out;
}

Result<DrakeSettings> read_drake_query(const Query& query) {
    DrakeSettings out;
    for (const auto& [name, value] : query) {
        const auto known = std::find(option_names.begin(), option_names.end(), name);
        if (name == "up") {
            if (value != "y" && value != "z") return bad_option(name, "expected y or z");
            out.z_up = value == "z";
        } else if (name == "labels") {
            if (value != "color" && value != "number")
                return bad_option(name, "expected color or number");
            out.labels = value == "color" ? LabelEncoding::color : LabelEncoding::number;
        } else if (known != option_names.end()) {
            out.options[name] = value_of(value);
        } else if (name != "token") {
            return bad_option(name, "the endpoint takes " + listed_options());
        }
    }
    return out;
}

void apply(const DrakeRequest& wanted, RenderRequest& request) {
    request.options.width = wanted.width;
    request.options.height = wanted.height;
    request.size_is_given = true;
    CameraRequest& camera = request.camera;
    camera.model = CameraModel::pinhole;
    camera.settings.near_m = wanted.near_m;
    camera.settings.far_m = wanted.far_m;
    camera.settings.intrinsics = wanted.intrinsics;
}

float sensed_depth(float depth_m, const std::array<double, 2>& range_m) {
    constexpr float too_near = 0;
    constexpr float too_far = std::numeric_limits<float>::infinity();
    if (!(depth_m > 0) || depth_m > static_cast<float>(range_m[1])) return too_far;
    return depth_m < static_cast<float>(range_m[0]) ? too_near : depth_m;
}

std::array<uint8_t, 3> label_color(const float* base_color) {
    constexpr float largest = 255;
    std::array<uint8_t, 3> out = {};
    for (size_t c = 0; c < out.size(); ++c)
        out[c] = static_cast<uint8_t>(std::lround(largest * std::clamp(base_color[c], 0.0f, 1.0f)));
    return out;
}

uint16_t label_number(const std::array<uint8_t, 3>& color) {
    return static_cast<uint16_t>(color[0] | color[1] << 8);
}

}  // namespace obscura::serve
