// python/module/fields.h - settings by name: as keywords, and as the attributes of a class.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "convert.h"
#include <cstring>

namespace obscura::python {

/// One setting of an `Owner`, as Python sees it.
template <typename Owner>
struct Field {
    const char* name;
    const char* doc;
    void (*set)(Owner&, py::handle, const Place&);
    py::object (*get)(const Owner&);
};

template <typename Member>
struct MemberOf;

template <typename Class, typename Type>
struct MemberOf<Type Class::*> {
    using Owner = Class;
    using Value = Type;
};

/// `Kind` reads and gives the value: Plain by its type, or FileName, Choice. `Owner` may derive
/// from the class that has the member.
template <auto member,
          typename Kind = Plain<typename MemberOf<decltype(member)>::Value>,
          typename Owner = typename MemberOf<decltype(member)>::Owner>
constexpr auto field(const char* name, const char* doc) {
    return Field<Owner>{name,
                        doc,
                        [](Owner& owner, py::handle value, const Place& place) {
                            owner.*member = Kind::from(value, place);
                        },
                        [](const Owner& owner) -> py::object { return Kind::to(owner.*member); }};
}

/// The fields of a class; `name` is what messages call it.
template <typename Owner>
struct Fields {
    const char* name;
    const Field<Owner>* first;
    std::size_t count;

    const Field<Owner>* begin() const { return first; }
    const Field<Owner>* end() const { return first + count; }
};

template <typename Owner, std::size_t n>
constexpr Fields<Owner> fields(const char* name, const std::array<Field<Owner>, n>& list) {
    return {name, list.data(), n};
}

/// Sets what the keywords say; TypeError for one that is not known.
template <typename Owner>
void set_fields(Owner& owner, const Fields<Owner>& all, const py::dict& keywords) {
    for (const auto& [key, value] : keywords) {
        const std::string name = py::str(key);
        const Field<Owner>* found = nullptr;
        std::string list;
        for (const Field<Owner>& one : all) {
            if (name == one.name) found = &one;
            list += (list.empty() ? "" : ", ") + std::string(one.name);
        }
        if (found == nullptr) {
            throw py::type_error(std::string(all.name) + "() has no keyword '" + name +
                                 "'; it has: " + list);
        }
        found->set(owner, value, {all.name, found->name});
    }
}

/// What differs from the defaults, by name.
template <typename Owner>
py::dict changed_fields(const Owner& owner, const Fields<Owner>& all) {
    const Owner usual;
    py::dict out;
    for (const Field<Owner>& one : all) {
        const py::object value = one.get(owner);
        if (!value.equal(one.get(usual))) out[one.name] = value;
    }
    return out;
}

template <typename Owner>
std::string shown_fields(const Owner& owner, const Fields<Owner>& all) {
    std::string out;
    for (const auto& [name, value] : changed_fields(owner, all)) {
        out += (out.empty() ? "" : ", ") + std::string(py::str(name)) + "=" +
               std::string(py::repr(value));
    }
    return std::string(all.name) + "(" + out + ")";
}

/// "name: what it is", one a line, below `head`.
template <typename Owner>
std::string documentation(const std::string& head, const Fields<Owner>& all) {
    std::string out = head + "\n\nKeywords, which are attributes as well:\n";
    for (const Field<Owner>& one : all)
        out += "\n    " + std::string(one.name) + ": " + one.doc;
    return out;
}

/// A class of settings: made by keywords, with attributes, comparable, picklable.
template <typename Owner>
py::class_<Owner> bind_fields(py::module_& module, const Fields<Owner>& all, const char* doc) {
    py::class_<Owner> out(module, all.name, documentation(doc, all).c_str());
    const auto made = [all](const py::dict& keywords) {
        Owner owner;
        set_fields(owner, all, keywords);
        return owner;
    };
    out.def(py::init([made](const py::kwargs& keywords) { return made(keywords); }));
    for (const Field<Owner>& one : all) {
        out.def_property(
            one.name,
            [&one](const Owner& owner) { return one.get(owner); },
            [&one, all](Owner& owner, const py::object& value) {
                one.set(owner, value, {all.name, one.name});
            },
            one.doc);
    }
    out.def(
        "replace",
        [all](Owner owner, const py::kwargs& keywords) {
            set_fields(owner, all, keywords);
            return owner;
        },
        "A copy in which these keywords are changed.");
    out.def("__repr__", [all](const Owner& owner) { return shown_fields(owner, all); });
    out.def("__eq__", [all](const Owner& owner, const py::object& other) -> py::object {
        if (!py::isinstance<Owner>(other)) {
            return py::reinterpret_borrow<py::object>(Py_NotImplemented);
        }
        return py::bool_(
            changed_fields(owner, all).equal(changed_fields(py::cast<const Owner&>(other), all)));
    });
    out.attr("__hash__") = py::none();
    out.def(py::pickle([all](const Owner& owner) { return changed_fields(owner, all); }, made));
    return out;
}

}  // namespace obscura::python
