// python/module/convert.cpp - values of Python become the library's, and back.
// SPDX-License-Identifier: Apache-2.0
#include "convert.h"

#include <algorithm>

namespace obscura::python {

namespace {

std::string shown(const Place& place) {
    return std::string(place.owner) + "." + place.name + ": ";
}

/// The characters of a str as UTF-8.
std::string utf8_of(py::handle value, const Place& place) {
    Py_ssize_t size = 0;
    const char* const bytes = PyUnicode_AsUTF8AndSize(value.ptr(), &size);
    if (bytes == nullptr) {
        PyErr_Clear();
        wrong_value(place, "the text has characters that UTF-8 lacks");
    }
    std::string out(bytes, static_cast<std::size_t>(size));
    if (out.find('\0') != std::string::npos) wrong_value(place, "the text has a NUL");
    return out;
}

enum class Numbers { whole, real };

/// An array of whole or real numbers with `count` elements; its shape may be that of a vector, or
/// of a square matrix where the count is one.
py::array numbers_of(py::handle value, const Place& place, std::size_t count, Numbers which) {
    const bool real = which == Numbers::real;
    const std::string expected = std::to_string(count) + (real ? " numbers" : " whole numbers");
    const bool is_text = PyUnicode_Check(value.ptr()) || PyBytes_Check(value.ptr());
    const py::array found = is_text ? py::array() : py::array::ensure(value);
    if (is_text || !found) {
        PyErr_Clear();
        wrong_type(place, expected, value);
    }
    const char kind = found.dtype().kind();  // an empty list is one of real numbers
    const bool fits = kind == 'i' || kind == 'u' || (kind == 'f' && (real || found.size() == 0));
    if (!fits) wrong_type(place, expected, value);
    const auto size = static_cast<std::size_t>(found.size());
    const std::size_t side = count == 16 ? 4 : count == 9 ? 3 : 0;
    const auto dimension = [&](py::ssize_t i) { return static_cast<std::size_t>(found.shape(i)); };
    const bool is_vector =
        found.ndim() == 1 || (found.ndim() == 2 && std::max(dimension(0), dimension(1)) == size);
    const bool is_square = side != 0 && found.ndim() == 2 && dimension(0) == side;
    if (size == count && (is_vector || is_square)) return found;
    std::string shape;
    for (py::ssize_t i = 0; i < found.ndim(); ++i)
        shape += (i == 0 ? "" : " x ") + std::to_string(found.shape(i));
    wrong_value(place,
                "expected " + expected + (side == 0 ? "" : ", flat or as rows") +
                    "; the shape is " + (shape.empty() ? "that of one number" : shape));
}

/// A whole number as Python's int.
py::object index_of(py::handle value, const Place& place) {
    const bool can = PyBool_Check(value.ptr()) == 0 && PyIndex_Check(value.ptr()) != 0;
    const auto index =
        py::reinterpret_steal<py::object>(can ? PyNumber_Index(value.ptr()) : nullptr);
    if (index) return index;
    PyErr_Clear();
    wrong_type(place, "a whole number", value);
}

}  // namespace

void wrong_type(const Place& place, const std::string& expected, py::handle got) {
    throw py::type_error(shown(place) + "expected " + expected + ", not " +
                         std::string(py::str(py::type::of(got).attr("__qualname__"))));
}

void wrong_value(const Place& place, const std::string& message) {
    throw py::value_error(shown(place) + message);
}

py::str text(const std::string& utf8) {
    PyObject* const made =
        PyUnicode_DecodeUTF8(utf8.data(), static_cast<Py_ssize_t>(utf8.size()), "surrogateescape");
    if (made == nullptr) throw py::error_already_set();
    return py::reinterpret_steal<py::str>(made);
}

py::tuple texts(const std::vector<std::string>& list) {
    py::tuple out(list.size());
    for (std::size_t i = 0; i < list.size(); ++i)
        out[i] = text(list[i]);
    return out;
}

double read_double(py::handle value, const Place& place) {
    const bool is_number = PyBool_Check(value.ptr()) == 0 && PyNumber_Check(value.ptr()) != 0;
    const double number = is_number ? PyFloat_AsDouble(value.ptr()) : 0;
    if (!is_number || PyErr_Occurred() != nullptr) {
        PyErr_Clear();
        wrong_type(place, "a number", value);
    }
    return number;
}

long long read_integer(py::handle value, const Place& place, long long low, long long high) {
    const py::object index = index_of(value, place);
    int overflow = 0;
    const long long number = PyLong_AsLongLongAndOverflow(index.ptr(), &overflow);
    if (overflow != 0 || number < low || number > high) {
        wrong_value(place,
                    std::string(py::str(index)) + " is out of range; expected from " +
                        std::to_string(low) + " to " + std::to_string(high));
    }
    return number;
}

std::uint64_t read_unsigned(py::handle value, const Place& place) {
    const py::object index = index_of(value, place);
    const unsigned long long number = PyLong_AsUnsignedLongLong(index.ptr());
    if (PyErr_Occurred() == nullptr) return number;
    PyErr_Clear();
    wrong_value(place, "expected a whole number from 0 to 2^64 - 1");
}

bool read_bool(py::handle value, const Place& place) {
    const std::string type = Py_TYPE(value.ptr())->tp_name;
    const bool is_bool = PyBool_Check(value.ptr()) || type == "numpy.bool_" || type == "numpy.bool";
    if (!is_bool) wrong_type(place, "True or False", value);
    return PyObject_IsTrue(value.ptr()) == 1;
}

std::string read_text(py::handle value, const Place& place) {
    if (!PyUnicode_Check(value.ptr())) wrong_type(place, "a str", value);
    return utf8_of(value, place);
}

std::string read_choice(py::handle value, const Place& place) {
    if (PyUnicode_Check(value.ptr())) return utf8_of(value, place);
    if (PyBool_Check(value.ptr()) != 0 || PyIndex_Check(value.ptr()) == 0) {
        wrong_type(place, "a name or an index", value);
    }
    return std::to_string(read_integer(value, place, 0, std::numeric_limits<int>::max()));
}

std::string read_file_name(py::handle value, const Place& place) {
    PyObject* encoded = nullptr;
    if (PyUnicode_FSConverter(value.ptr(), static_cast<void*>(&encoded)) == 0) {
        const bool is_type = PyErr_ExceptionMatches(PyExc_TypeError) != 0;
        PyErr_Clear();
        if (is_type) wrong_type(place, "a str or a path", value);
        wrong_value(place, "it is no name of a file");
    }
    const auto bytes = py::reinterpret_steal<py::bytes>(encoded);
    return bytes;
}

void read_doubles(py::handle value, const Place& place, double* out, std::size_t count) {
    const py::array found = numbers_of(value, place, count, Numbers::real);
    const py::array_t<double, py::array::c_style | py::array::forcecast> numbers(found);
    std::copy_n(numbers.data(), count, out);
}

void read_integers(py::handle value, const Place& place, int* out, std::size_t count) {
    const py::array found = numbers_of(value, place, count, Numbers::whole);
    const py::array_t<std::int64_t, py::array::c_style | py::array::forcecast> numbers(found);
    using Limits = std::numeric_limits<int>;
    for (std::size_t i = 0; i < count; ++i) {
        const std::int64_t number = numbers.data()[i];
        if (number < Limits::min() || number > Limits::max()) {
            wrong_value(place, std::to_string(number) + " is out of range");
        }
        out[i] = static_cast<int>(number);
    }
}

std::vector<std::string> read_texts(py::handle value, const Place& place) {
    // A str is a sequence of its letters, which nobody means.
    const bool is_text = PyUnicode_Check(value.ptr()) || PyBytes_Check(value.ptr());
    if (is_text || !py::isinstance<py::iterable>(value)) {
        wrong_type(place, "a list of str, as ['normal']", value);
    }
    std::vector<std::string> out;
    for (const py::handle one : value)
        out.push_back(read_text(one, place));
    return out;
}

int read_name(py::handle value, const Place& place, const char* const* names, std::size_t count) {
    const std::string name = read_text(value, place);
    std::string list;
    for (std::size_t i = 0; i < count; ++i) {
        if (name == names[i]) return static_cast<int>(i);
        list += (i == 0 ? "" : ", ") + std::string(names[i]);
    }
    wrong_value(place, "'" + name + "' is no choice; expected one of: " + list);
}

}  // namespace obscura::python
