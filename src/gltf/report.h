// gltf/report.h - reports which features each part of a file uses, and their support.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/parse/extensions.h"

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string_view>

namespace obscura::gltf {

/// Something of glTF itself that a part of a file may ask for.
///
/// To add one: an entry in report.cpp, whose function says when a part asks for it.
struct FeatureEntry {
    std::string_view array;  ///< of the file: "materials"
    std::string_view name;
    Verdict verdict;
    std::string_view note;
    bool (*is_used)(const nlohmann::json& part);
};

std::span<const FeatureEntry> feature_table();

std::string_view verdict_name(Verdict verdict);  ///< "honoured", "approximated", "ignored"

/// Every extension and feature of every part, from extension_table and feature_table. Parts that
/// ask for nothing are left out.
std::vector<ReportEntry> make_report(const nlohmann::json& tree);

}  // namespace obscura::gltf
