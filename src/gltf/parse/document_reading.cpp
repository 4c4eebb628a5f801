// gltf/parse/document_reading.cpp - helpers that the readers of a document share.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/document_reading.h"

namespace obscura::gltf {

std::string name_or(const std::string& name, const char* what, size_t index) {
    return name.empty() ? std::string(what) + " " + std::to_string(index) : name;
}

void clamp_numbers(DocumentReading& reading,
                   const std::string& pointer,
                   std::span<double> values,
                   const NumberLimits& limits) {
    bool noted = false;
    for (double& value : values) {
        const double inside = clamped(value, limits);
        if (inside != value && !noted) {
            reading.clamped.push_back(pointer);
            noted = true;
        }
        value = inside;
    }
}

void clamped_numbers(DocumentReading& reading,
                     const ValueReader& object,
                     std::string_view place,
                     std::span<double> out,
                     const NumberLimits& limits) {
    const size_t slash = place.find('/');
    if (slash != std::string_view::npos) {
        const ValueReader child = object.child(place.substr(0, slash));
        clamped_numbers(reading, child, place.substr(slash + 1), out, limits);
        return;
    }
    if (out.size() == 1) {
        out[0] = object.number(place, out[0]);
    } else {
        object.numbers(place, out);
    }
    clamp_numbers(reading, object.pointer() + "/" + std::string(place), out, limits);
}

}  // namespace obscura::gltf
