// python/module/convert.h - values of Python become the library's, and back.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <obscura/obscura.h>
#include <optional>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <string>
#include <type_traits>
#include <vector>

namespace obscura::python {

namespace py = pybind11;

/// What a message names: "View.eye".
struct Place {
    const char* owner;
    const char* name;
};

[[noreturn]] void wrong_type(const Place& place, const std::string& expected, py::handle got);
[[noreturn]] void wrong_value(const Place& place, const std::string& message);

/// Text of the library for Python. Bytes that are not UTF-8, as names of files may have them, are
/// kept the way Python keeps them.
py::str text(const std::string& utf8);
py::tuple texts(const std::vector<std::string>& list);

double read_double(py::handle value, const Place& place);
long long read_integer(py::handle value, const Place& place, long long low, long long high);
std::uint64_t read_unsigned(py::handle value, const Place& place);
bool read_bool(py::handle value, const Place& place);
std::string read_text(py::handle value, const Place& place);
/// A name, or an index as the number that it is.
std::string read_choice(py::handle value, const Place& place);
/// str, bytes or os.PathLike, as the file system's bytes.
std::string read_file_name(py::handle value, const Place& place);
/// `count` numbers of a sequence or an array; of 9 or 16 also as rows.
void read_doubles(py::handle value, const Place& place, double* out, std::size_t count);
void read_integers(py::handle value, const Place& place, int* out, std::size_t count);
std::vector<std::string> read_texts(py::handle value, const Place& place);
/// The position of a name in a list.
int read_name(py::handle value, const Place& place, const char* const* names, std::size_t count);

/// The names of an enumeration, in its order.
template <typename T>
struct Names;

template <>
struct Names<CameraModel> {
    static constexpr std::array list = {
        "pinhole", "orthographic", "thin_lens", "fisheye", "environment"};
};

template <>
struct Names<Background> {
    static constexpr std::array list = {"environment", "transparent", "color"};
};

template <>
struct Names<Integrator> {
    static constexpr std::array list = {"path",
                                        "direct",
                                        "raycast",
                                        "ao",
                                        "normal",
                                        "facing",
                                        "depth",
                                        "distance",
                                        "uv",
                                        "albedo",
                                        "id",
                                        "wireframe",
                                        "heat"};
};

template <>
struct Names<PixelFilter> {
    static constexpr std::array list = {"box", "gaussian", "blackman_harris"};
};

template <>
struct Names<ExrLayout> {
    static constexpr std::array list = {"single", "multipart", "separate"};
};

template <>
struct Names<LayerKind> {
    static constexpr std::array list = {"color", "data", "id"};
};

template <typename T>
py::str name_of(T value) {
    return Names<T>::list.at(static_cast<std::size_t>(value));
}

/// How a value of one type is read and given, where its type alone decides.
template <typename T, typename = void>
struct Plain;

template <>
struct Plain<double> {
    static double from(py::handle value, const Place& place) { return read_double(value, place); }
    static py::object to(double value) { return py::float_(value); }
};

template <>
struct Plain<int> {
    static int from(py::handle value, const Place& place) {
        using Limits = std::numeric_limits<int>;
        return static_cast<int>(read_integer(value, place, Limits::min(), Limits::max()));
    }
    static py::object to(int value) { return py::int_(value); }
};

template <>
struct Plain<std::uint64_t> {
    static std::uint64_t from(py::handle value, const Place& place) {
        return read_unsigned(value, place);
    }
    static py::object to(std::uint64_t value) { return py::int_(value); }
};

template <>
struct Plain<bool> {
    static bool from(py::handle value, const Place& place) { return read_bool(value, place); }
    static py::object to(bool value) { return py::bool_(value); }
};

template <>
struct Plain<std::vector<std::string>> {
    static std::vector<std::string> from(py::handle value, const Place& place) {
        return read_texts(value, place);
    }
    static py::object to(const std::vector<std::string>& value) { return texts(value); }
};

template <>
struct Plain<Rect> {
    static Rect from(py::handle value, const Place& place) {
        std::array<int, 4> out = {};
        read_integers(value, place, out.data(), out.size());
        return {out[0], out[1], out[2], out[3]};
    }
    static py::object to(const Rect& r) { return py::make_tuple(r.x, r.y, r.width, r.height); }
};

template <>
struct Plain<OpenCvCamera> {
    static OpenCvCamera from(py::handle value, const Place& place) {
        if (!py::isinstance<OpenCvCamera>(value)) wrong_type(place, "an OpenCvCamera", value);
        return py::cast<OpenCvCamera>(value);
    }
    static py::object to(const OpenCvCamera& value) { return py::cast(value); }
};

template <typename T>
struct Plain<T, std::enable_if_t<std::is_enum_v<T>>> {
    static T from(py::handle value, const Place& place) {
        constexpr auto& names = Names<T>::list;
        return static_cast<T>(read_name(value, place, names.data(), names.size()));
    }
    static py::object to(T value) { return name_of(value); }
};

template <typename T>
py::tuple numbers(const T* first, std::size_t count) {
    py::tuple out(count);
    for (std::size_t i = 0; i < count; ++i)
        out[i] = first[i];
    return out;
}

/// Matrices of 3x3 and 4x4 numbers are given as rows.
template <std::size_t n>
struct Plain<std::array<double, n>> {
    static std::array<double, n> from(py::handle value, const Place& place) {
        std::array<double, n> out = {};
        read_doubles(value, place, out.data(), n);
        return out;
    }
    static py::object to(const std::array<double, n>& value) {
        constexpr std::size_t side = n == 16 ? 4 : n == 9 ? 3 : 0;
        if constexpr (side == 0) {
            return numbers(value.data(), n);
        } else {
            py::tuple rows(side);
            for (std::size_t r = 0; r < side; ++r)
                rows[r] = numbers(value.data() + r * side, side);
            return rows;
        }
    }
};

template <std::size_t n>
struct Plain<std::array<float, n>> {
    static std::array<float, n> from(py::handle value, const Place& place) {
        const auto wide = Plain<std::array<double, n>>::from(value, place);
        std::array<float, n> out = {};
        for (std::size_t i = 0; i < n; ++i)
            out[i] = static_cast<float>(wide[i]);
        return out;
    }
    static py::object to(const std::array<float, n>& value) { return numbers(value.data(), n); }
};

template <std::size_t n>
struct Plain<std::array<int, n>> {
    static std::array<int, n> from(py::handle value, const Place& place) {
        std::array<int, n> out = {};
        read_integers(value, place, out.data(), n);
        return out;
    }
    static py::object to(const std::array<int, n>& value) { return numbers(value.data(), n); }
};

/// None where there is nothing.
template <typename T>
struct Plain<std::optional<T>> {
    static std::optional<T> from(py::handle value, const Place& place) {
        if (value.is_none()) return std::nullopt;
        return Plain<T>::from(value, place);
    }
    static py::object to(const std::optional<T>& value) {
        return value ? Plain<T>::to(*value) : py::none();
    }
};

/// A text, or one that `read` reads; the empty one, which is the library's for "not given", is
/// None.
template <std::string (*read)(py::handle, const Place&)>
struct TextBy {
    static std::string from(py::handle value, const Place& place) {
        return value.is_none() ? std::string() : read(value, place);
    }
    static py::object to(const std::string& value) {
        if (value.empty()) return py::none();
        return text(value);
    }
    static py::object to(const std::optional<std::string>& value) { return to(value.value_or("")); }
};

template <>
struct Plain<std::string> : TextBy<read_text> {};
using FileName = TextBy<read_file_name>;
using Choice = TextBy<read_choice>;

}  // namespace obscura::python
