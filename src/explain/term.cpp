// explain/term.cpp - formats numbers and vectors for people.
// SPDX-License-Identifier: Apache-2.0
#include "explain/term.h"

#include <cmath>
#include <fmt/format.h>

namespace obscura {

std::string format_number(double number, int digits) {
    return fmt::format("{:.{}g}", number + 0.0, digits);  // -0 + 0 is 0
}

std::string format_value(const std::vector<double>& value, int digits) {
    if (value.size() == 1) return format_number(value[0], digits);
    double largest = 0;
    for (const double number : value)
        largest = std::isfinite(number) ? std::fmax(largest, std::fabs(number)) : largest;
    std::string out;
    for (const double number : value) {
        const bool rounding = std::fabs(number) < 1e-14 * largest;
        out += (out.empty() ? "(" : ", ") + format_number(rounding ? 0 : number, digits);
    }
    return out + ")";
}

std::string format_value(const Vec3d& v, int digits) {
    return format_value(std::vector<double>{v.x, v.y, v.z}, digits);
}

std::string format_term(const Term& term, int digits) {
    return term.name + " = " + format_value(term.value, digits);
}

}  // namespace obscura
