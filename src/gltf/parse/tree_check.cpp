// gltf/parse/tree_check.cpp - checks one object of a JSON tree by its rules.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/tree_check.h"

#include "gltf/parse/value_reader.h"

#include <algorithm>

namespace obscura::gltf {

namespace {

using nlohmann::json;

/// Makes 3.0 a 3. False: it is no integer from 0 to 2^53.
bool make_integer(json& value) {
    const std::optional<uint64_t> exact = JsonTree::integer(value);
    if (!exact) return false;
    if (!value.is_number_unsigned()) value = *exact;
    return true;
}

bool make_index(json& value, size_t count) {
    return make_integer(value) && value.get<uint64_t>() < std::min<size_t>(count, INT32_MAX);
}

bool make_count(json& value) {
    if (!make_integer(value)) return false;
    if (value.get<uint64_t>() > INT32_MAX) value = static_cast<uint64_t>(INT32_MAX);
    return true;
}

template <typename Test>
bool all_in(json& values, const Test& test) {
    return std::all_of(values.begin(), values.end(), test);
}

bool is_number(const json& value) {
    return value.is_number();
}

/// False: the member is wrong. What is in objects is checked later.
bool fits(json& value, const MemberRule& rule, size_t count) {
    const auto is_index = [&](json& element) { return make_index(element, count); };
    const auto is_map = [&](json& map) { return map.is_object() && all_in(map, is_index); };
    switch (rule.type) {
        case MemberType::text:
            return value.is_string();
        case MemberType::number:
            return value.is_number();
        case MemberType::boolean:
            return value.is_boolean();
        case MemberType::size:
            return make_integer(value);
        case MemberType::count:
            return make_count(value);
        case MemberType::numbers:
            return value.is_array() && value.size() == rule.width && all_in(value, is_number);
        case MemberType::index:
            return is_index(value);
        case MemberType::indices:
            return value.is_array() && all_in(value, is_index);
        case MemberType::index_map:
            return is_map(value);
        case MemberType::index_maps:
            return value.is_array() && all_in(value, is_map);
        case MemberType::object:
            return value.is_object();
        case MemberType::objects:
            return value.is_array();
    }
    return false;
}

/// Reads a member that does not fit, which records the fault.
void read_member(const JsonReader& reader, const MemberRule& rule, size_t count) {
    const char* what = tree_array_names[static_cast<size_t>(rule.array)].what;
    const auto read_map = [&](const JsonReader& map) {
        map.each_key([&](const std::string& name) { map.index(name, count, what); });
    };
    std::vector<double> values(rule.width);
    switch (rule.type) {
        case MemberType::text:
            reader.text(rule.key);
            break;
        case MemberType::number:
            reader.number(rule.key, 0);
            break;
        case MemberType::boolean:
            reader.boolean(rule.key, false);
            break;
        case MemberType::size:
        case MemberType::count:
            reader.size(rule.key, 0);
            break;
        case MemberType::numbers:
            reader.numbers(rule.key, values);
            break;
        case MemberType::index:
            reader.index(rule.key, count, what);
            break;
        case MemberType::indices:
            reader.indices(rule.key, count, what);
            break;
        case MemberType::index_map:
            read_map(reader.child(rule.key));
            break;
        case MemberType::index_maps:
            reader.each(rule.key, [&](const JsonReader& map, size_t) { read_map(map); });
            break;
        case MemberType::object:
            reader.child(rule.key);
            break;
        case MemberType::objects:
            reader.count(rule.key);
            break;
    }
}

size_t count_for(const MemberRule& rule, const TreeCheck& check) {
    return check.counts[static_cast<size_t>(rule.array)];
}

/// Reports what is wrong: missing members first, then in the rules' order.
void find_fault(const json& object,
                const ObjectRules& rules,
                const TreePlace& place,
                const TreeCheck& check) {
    const JsonReader reader(object, place.text(), check.fault);
    for (const MemberRule& rule : rules.members) {
        if (rule.required) reader.require(rule.key);
    }
    for (const MemberRule& rule : rules.members)
        read_member(reader, rule, count_for(rule, check));
}

bool members_fit(json& object, const ObjectRules& rules, const TreeCheck& check) {
    size_t missing = static_cast<size_t>(
        std::count_if(rules.members.begin(), rules.members.end(), [](const MemberRule& r) {
            return r.required;
        }));
    for (auto& [key, value] : object.get_ref<json::object_t&>()) {
        for (const MemberRule& rule : rules.members) {
            if (rule.key != key) continue;
            if (!fits(value, rule, count_for(rule, check))) return false;
            if (rule.required) --missing;
            break;
        }
    }
    return missing == 0;
}

void check_inside(json& object,
                  const ObjectRules& rules,
                  const TreePlace& place,
                  TreeCheck& check) {
    for (const MemberRule& rule : rules.members) {
        if (rule.rules == nullptr) continue;
        const auto found = object.find(rule.key);
        if (found == object.end()) continue;
        const TreePlace inside{&place, rule.key};
        if (rule.type == MemberType::object) {
            check_object(*found, *rule.rules, inside, check);
            continue;
        }
        for (size_t i = 0; i < found->size() && !check.fault.error; ++i)
            check_object((*found)[i], *rule.rules, {&inside, {}, i}, check);
    }
}

/// Takes out what is not read and marks the rest.
void check_extensions(json& object,
                      const ObjectRules& rules,
                      const TreePlace& place,
                      const TreeCheck& check) {
    const auto found = object.find("extensions");
    if (found == object.end()) return;
    if (!rules.has_extensions) {
        object.erase(found);
        return;
    }
    const JsonReader extensions = JsonReader(object, place.text(), check.fault).child("extensions");
    if (check.fault.error) return;
    auto& members = found->get_ref<json::object_t&>();
    for (auto member = members.begin(); member != members.end();) {
        const std::string& name = member->first;
        if (std::find(rules.extensions.begin(), rules.extensions.end(), name) ==
            rules.extensions.end()) {
            member = members.erase(member);
            continue;
        }
        // Of this one nothing but its presence is read.
        if (name == "KHR_materials_unlit") member->second = json::object();
        extensions.child(name);
        for (json& element : member->second)
            mark_for_values(element);
        ++member;
    }
}

}  // namespace

std::string TreePlace::text() const {
    if (above == nullptr && key.empty()) return {};
    const std::string before = above == nullptr ? std::string() : above->text();
    return before + (key.empty() ? "/" + std::to_string(index) : json_pointer_part(key));
}

void check_object(json& object,
                  const ObjectRules& rules,
                  const TreePlace& place,
                  TreeCheck& check) {
    if (!object.is_object() || !members_fit(object, rules, check)) {
        find_fault(object, rules, place, check);
        return;
    }
    check_inside(object, rules, place, check);
    if (!check.fault.error) check_extensions(object, rules, place, check);
}

}  // namespace obscura::gltf
