// gltf/parse/camera_extension.h - reads the extension OBSCURA_camera of a glTF camera.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/parse/number_entry.h"
#include "gltf/parse/value_reader.h"
#include "scene/camera_setting_table.h"

namespace obscura::gltf {

inline constexpr const char* camera_extension_name = "OBSCURA_camera";

/// Reads the extension's object; docs/extensions/OBSCURA_camera/README.md specifies it.
///
/// Errors  faults of the reader: 65 E-CAM-KEY a key that the specification does not have,
///         E-CAM-VALUE a value out of its range, E-JSON-TYPE
CameraSettings read_camera_extension(const ValueReader& object);

inline constexpr const char* camera_value_id = "E-CAM-VALUE";

/// An entry of camera_setting_table, of which animations want the real numbers.
struct LensEntry {
    CameraSettingInfo info;  ///< numbers outside its range are a fault
    bool is_real;            ///< a real number, or a list of them
    /// The numbers in settings; empty where they are absent or not numbers.
    std::span<double> (*numbers)(CameraSettings& settings);
};

extern const std::span<const LensEntry> lens_entries;

/// Path of a setting in the extension's object, as in a JSON pointer: "lens/fstop".
std::string lens_place(const CameraSettingInfo& info);
/// The range to name in a fault of numbers outside it; nothing: they are good.
std::optional<std::string> lens_fault(const CameraSettingInfo& info,
                                      std::span<const double> numbers);
/// The same of an integer.
std::optional<std::string> count_fault(const CameraSettingInfo& info, double count);
/// The same of `far`, which must lie behind `near`.
std::optional<std::string> clipping_fault(const CameraSettings& settings);

}  // namespace obscura::gltf
