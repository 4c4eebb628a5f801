// explain/term.h - a number or vector with the name that the lecture gives it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "math/vec.h"

#include <string>
#include <vector>

namespace obscura {

struct Term {
    std::string name;
    std::vector<double> value;  ///< one number, or the components of a vector

    Term(std::string its_name, double x) : name(std::move(its_name)), value{x} {}
    Term(std::string its_name, double x, double y) : name(std::move(its_name)), value{x, y} {}
    Term(std::string its_name, const Vec3d& v) : name(std::move(its_name)), value{v.x, v.y, v.z} {}
};

/// So many digits at most, none of them zeros at the end; never "-0".
std::string format_number(double number, int digits = 9);
/// "(x, y, z)", or the number alone. A component that is only rounding error of the others in
/// double precision is shown as 0.
std::string format_value(const std::vector<double>& value, int digits = 9);
std::string format_value(const Vec3d& v, int digits = 9);
/// "name = value".
std::string format_term(const Term& term, int digits = 9);

}  // namespace obscura
