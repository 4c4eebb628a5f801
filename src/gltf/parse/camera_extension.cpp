// gltf/parse/camera_extension.cpp - reads the extension OBSCURA_camera of a glTF camera.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/camera_extension.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <type_traits>
#include <utility>

namespace obscura::gltf {

namespace {

constexpr const char* value_id = camera_value_id;

void refuse_other_keys(const ValueReader& object, const std::vector<std::string>& known) {
    object.each_key([&](const std::string& key) {
        const bool expected = std::find(known.begin(), known.end(), key) != known.end();
        if (expected || key == "extras" || key == "extensions") return;
        std::string names;
        for (const std::string& name : known)
            names += (names.empty() ? "" : ", ") + name;
        object.fault(key, "E-CAM-KEY", "there is no such key here; expected one of: " + names);
    });
}

/// "expected numbers from -100 to 100"
std::string range_text(const CameraSettingInfo& info, size_t count) {
    const auto text = [](double number) { return nlohmann::json(number).dump(); };
    return std::string("expected ") + (count == 1 ? "a number" : "numbers") + " from " +
           text(info.range.low) + " to " + text(info.range.high);
}

template <typename T>
void read_choice(const ValueReader& object,
                 const char* key,
                 std::span<const Named<T>> names,
                 std::optional<T>& out) {
    if (!object.has(key)) return;
    const std::string text = object.text(key);
    std::string accepted;
    for (const Named<T>& entry : names) {
        if (text == entry.name) out = entry.value;
        accepted += (accepted.empty() ? "" : ", ") + std::string(entry.name);
    }
    if (!out) object.fault(key, value_id, "expected one of: " + accepted);
}

void read_value(const ValueReader& object,
                const CameraSettingInfo& info,
                std::optional<double>& out) {
    if (!object.has(info.key)) return;
    const double value = object.number(info.key, info.range.low);
    if (const auto wrong = lens_fault(info, {&value, 1})) {
        object.fault(info.key, value_id, *wrong);
    }
    out = value;
}

void read_value(const ValueReader& object, const CameraSettingInfo& info, std::optional<int>& out) {
    if (!object.has(info.key)) return;
    const uint64_t value = object.size(info.key, static_cast<uint64_t>(info.range.low));
    if (const auto wrong = count_fault(info, static_cast<double>(value))) {
        object.fault(info.key, value_id, *wrong);
    }
    out = static_cast<int>(value);
}

template <size_t N>
void read_value(const ValueReader& object,
                const CameraSettingInfo& info,
                std::optional<std::array<double, N>>& out) {
    std::array<double, N> values = {};
    if (!object.numbers(info.key, values)) return;
    if (const auto wrong = lens_fault(info, values)) object.fault(info.key, value_id, *wrong);
    out = values;
}

/// Reads the settings of one section of the table; `own` are further keys of the object.
void read_section(const ValueReader& object,
                  std::string_view section,
                  const std::vector<std::string>& own,
                  CameraSettings& out) {
    std::vector<std::string> keys = own;
    for_each_camera_setting([&](const auto& entry) {
        if (entry.info.key && entry.info.section == section) keys.emplace_back(entry.info.key);
    });
    refuse_other_keys(object, keys);
    for_each_camera_setting([&](const auto& entry) {
        using T = typename std::remove_cvref_t<decltype(out.*entry.member)>::value_type;
        if (!entry.info.key || entry.info.section != section) return;
        if constexpr (std::is_enum_v<T>) {
            read_choice(object, entry.info.key, entry.choices, out.*entry.member);
        } else if constexpr (!std::is_same_v<T, std::string> && !std::is_same_v<T, Intrinsics>) {
            read_value(object, entry.info, out.*entry.member);
        }
    });
}

template <typename T>
constexpr bool is_real = std::is_same_v<T, double>;
template <size_t N>
constexpr bool is_real<std::array<double, N>> = true;

template <size_t entry>
constexpr auto member_of = std::get<entry>(camera_setting_table).member;

template <size_t entry>
using MemberType =
    typename std::remove_cvref_t<decltype(CameraSettings{}.*member_of<entry>)>::value_type;

template <size_t entry>
std::span<double> said_numbers(CameraSettings& settings) {
    auto& value = settings.*member_of<entry>;
    if constexpr (is_real<MemberType<entry>>) {
        if (value) return span_of(*value);
    }
    return {};
}

template <size_t... entry>
constexpr auto entries_of(std::index_sequence<entry...>) {
    return std::array{LensEntry{std::get<entry>(camera_setting_table).info,
                                is_real<MemberType<entry>>,
                                said_numbers<entry>}...};
}

constexpr size_t entry_count = std::tuple_size_v<decltype(camera_setting_table)>;
constexpr auto entries = entries_of(std::make_index_sequence<entry_count>());

}  // namespace

const std::span<const LensEntry> lens_entries = entries;

std::string lens_place(const CameraSettingInfo& info) {
    const std::string section = info.section;
    return section + (section.empty() ? "" : "/") + info.key;
}

std::optional<std::string> lens_fault(const CameraSettingInfo& info,
                                      std::span<const double> numbers) {
    const auto inside = [&](double n) { return n >= info.range.low && n <= info.range.high; };
    if (std::all_of(numbers.begin(), numbers.end(), inside)) return std::nullopt;
    return range_text(info, numbers.size());
}

std::optional<std::string> count_fault(const CameraSettingInfo& info, double count) {
    const auto low = static_cast<uint64_t>(info.range.low);
    const auto high = static_cast<uint64_t>(info.range.high);
    if (count >= info.range.low && count <= info.range.high) return std::nullopt;
    return "expected " + std::to_string(low) + " to " + std::to_string(high);
}

std::optional<std::string> clipping_fault(const CameraSettings& settings) {
    if (!settings.far_m || *settings.far_m > settings.near_m.value_or(0)) return std::nullopt;
    return "expected more than near";
}

CameraSettings read_camera_extension(const ValueReader& object) {
    CameraSettings out;
    const std::array<const char*, 4> sections = {"lens", "fisheye", "environment", "exposure"};
    std::vector<std::string> own = {"model"};
    own.insert(own.end(), sections.begin(), sections.end());
    read_choice<CameraModel>(object, "model", camera_model_names, out.model);
    read_section(object, "", own, out);
    for (const char* section : sections) {
        if (object.has(section)) read_section(object.child(section), section, {}, out);
    }
    if (out.fstop && out.lens_radius_m) {
        object.child("lens").fault("radius", value_id, "expected either this or fstop");
    }
    if (out.fisheye_k && out.fisheye.value_or(FisheyeLaw::opencv) != FisheyeLaw::opencv) {
        object.child("fisheye").fault(
            "coefficients", value_id, "they are for the projection opencv only");
    }
    if (out.ev100 && (out.shutter_s || out.iso)) {
        object.child("exposure")
            .fault("ev100", value_id, "expected either this or shutter and iso");
    }
    if (const auto wrong = clipping_fault(out)) object.fault("far", value_id, *wrong);
    out.model = implied_model(out);
    if (out.model == CameraModel::thin_lens && !out.fstop && !out.lens_radius_m) {
        object.fault("lens", value_id, "a thin lens needs fstop or radius");
    }
    return out;
}

}  // namespace obscura::gltf
