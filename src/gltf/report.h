// gltf/report.h - part by part, what a file asks for and what becomes of it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/parse/extensions.h"

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string_view>

namespace obscura {

/// Something of glTF itself that a part of a file may ask for.
///
/// To add one: a row in report.cpp, whose function says when a part asks for it.
struct FeatureRow {
    std::string_view array;  ///< of the file: "materials"
    std::string_view name;
    Verdict verdict;
    std::string_view note;
    bool (*is_used)(const nlohmann::json& part);
};

std::span<const FeatureRow> feature_table();

std::string_view verdict_name(Verdict verdict);  ///< "honoured", "approximated", "ignored"

/// Every extension and feature of every part, from extension_table and feature_table. Parts that
/// ask for nothing are left out.
std::vector<ReportRow> make_report(const nlohmann::json& tree);

}  // namespace obscura
