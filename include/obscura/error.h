// include/obscura/error.h - what went wrong and where, and results that may be errors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "obscura/api.h"
#include <string>
#include <utility>
#include <variant>
#include <vector>

OBSCURA_BEGIN_API

/// One failure. The library throws nothing: calls return a Result.
struct Error {
    std::string id;     ///< stable, for programs: "E-CAM-UNKNOWN"
    std::string place;  ///< a file, with a JSON pointer into it; or the field that was set
    std::string text;   ///< for people: what is wrong and what would be accepted
    int code = 70;      ///< the exit code of the program `obscura` for it; docs/cli.md has the list
    std::vector<Error> also;  ///< further failures that were found together with this one
};

/// A value, or the error in its place.
template <typename T>
class Result {
public:
    Result(T value) : content_(std::in_place_index<0>, std::move(value)) {}
    Result(Error error) : content_(std::in_place_index<1>, std::move(error)) {}

    bool has_value() const noexcept { return content_.index() == 0; }
    explicit operator bool() const noexcept { return has_value(); }

    /// Throws std::bad_variant_access when there is an error.
    T& value() & { return std::get<0>(content_); }
    const T& value() const& { return std::get<0>(content_); }
    T&& value() && { return std::get<0>(std::move(content_)); }

    T& operator*() & { return value(); }
    const T& operator*() const& { return value(); }
    T&& operator*() && { return std::move(*this).value(); }
    T* operator->() { return &value(); }
    const T* operator->() const { return &value(); }

    /// Throws std::bad_variant_access when there is none.
    const Error& error() const { return std::get<1>(content_); }

private:
    std::variant<T, Error> content_;
};

/// Success, or an error.
template <>
class Result<void> {
public:
    Result() = default;
    Result(Error error) : content_(std::in_place_index<1>, std::move(error)) {}

    bool has_value() const noexcept { return content_.index() == 0; }
    explicit operator bool() const noexcept { return has_value(); }
    const Error& error() const { return std::get<1>(content_); }

private:
    std::variant<std::monostate, Error> content_;
};

OBSCURA_END_API
