// gltf/decode/accessors.cpp - reads accessors into flat arrays of float or uint32.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/decode/accessors.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <numeric>

namespace obscura::gltf {

namespace {

/// Limit on accessors without a view, whose count no bytes bound.
constexpr uint64_t largest_count_of_zeros = 1U << 24;

uint64_t column_size(const GltfAccessor& accessor) {
    const uint64_t bytes =
        component_size(accessor.component) * static_cast<uint64_t>(accessor.rows);
    return accessor.columns == 1 ? bytes : (bytes + 3) / 4 * 4;
}

uint64_t element_stride(const Document& document, const GltfAccessor& accessor) {
    const uint64_t stride =
        accessor.view < 0 ? 0 : document.views[static_cast<size_t>(accessor.view)].byte_stride;
    return stride != 0 ? stride : element_size(accessor);
}

ElementRange element_range(const Document& document, const GltfAccessor& accessor) {
    return {accessor.byte_offset,
            element_stride(document, accessor),
            accessor.count,
            element_size(accessor)};
}

ElementRange packed_range(uint64_t offset, uint64_t count, uint64_t size) {
    return {offset, size, count, size};
}

const GltfBufferView& view_of(const Document& document, int view) {
    return document.views[static_cast<size_t>(view)];
}

template <typename T>
T load(const std::byte* from) {
    T out;
    std::memcpy(&out, from, sizeof(T));
    return out;
}

/// glTF 2.0 section 3.11: conversion of normalised integers.
template <typename T, bool normalized>
float to_float(T value) {
    if constexpr (!normalized || std::is_floating_point_v<T>) {
        return static_cast<float>(value);
    } else if constexpr (std::is_signed_v<T>) {
        return std::max(
            static_cast<float>(value) / static_cast<float>(std::numeric_limits<T>::max()), -1.0f);
    } else {
        return static_cast<float>(value) / static_cast<float>(std::numeric_limits<T>::max());
    }
}

/// Elements of one accessor in memory that has been checked.
struct Elements {
    const std::byte* data;
    uint64_t stride;
    uint64_t column_size;
    int rows;
    int columns;
};

template <typename T, bool normalized>
void convert_element(const Elements& from, uint64_t element, float* out) {
    const std::byte* start = from.data + element * from.stride;
    for (int column = 0; column < from.columns; ++column) {
        const std::byte* component = start + static_cast<uint64_t>(column) * from.column_size;
        for (int row = 0; row < from.rows; ++row, component += sizeof(T)) {
            *out++ = to_float<T, normalized>(load<T>(component));
        }
    }
}

template <typename T, bool normalized>
void convert_elements(const Elements& from,
                      uint64_t count,
                      const ElementChoice& choice,
                      float* out) {
    const size_t width = static_cast<size_t>(from.rows) * static_cast<size_t>(from.columns);
    if (!choice.all) {
        for (const uint32_t element : choice.elements) {
            convert_element<T, normalized>(from, element, out);
            out += width;
        }
        return;
    }
    if (std::is_same_v<T, float> && from.stride == width * sizeof(float)) {
        std::memcpy(out, from.data, count * width * sizeof(float));
        return;
    }
    for (uint64_t element = 0; element < count; ++element, out += width) {
        convert_element<T, normalized>(from, element, out);
    }
}

template <typename T>
void convert_as(const Elements& from,
                const GltfAccessor& accessor,
                const ElementChoice& choice,
                float* out) {
    if (accessor.normalized) {
        convert_elements<T, true>(from, accessor.count, choice, out);
    } else {
        convert_elements<T, false>(from, accessor.count, choice, out);
    }
}

void convert(const Elements& from,
             const GltfAccessor& accessor,
             const ElementChoice& choice,
             float* out) {
    switch (accessor.component) {
        case ComponentType::int8:
            return convert_as<int8_t>(from, accessor, choice, out);
        case ComponentType::uint8:
            return convert_as<uint8_t>(from, accessor, choice, out);
        case ComponentType::int16:
            return convert_as<int16_t>(from, accessor, choice, out);
        case ComponentType::uint16:
            return convert_as<uint16_t>(from, accessor, choice, out);
        case ComponentType::uint32:
            return convert_as<uint32_t>(from, accessor, choice, out);
        case ComponentType::float32:
            return convert_as<float>(from, accessor, choice, out);
    }
}

uint32_t load_unsigned(const std::byte* from, ComponentType type) {
    switch (type) {
        case ComponentType::uint8:
            return load<uint8_t>(from);
        case ComponentType::uint16:
            return load<uint16_t>(from);
        default:
            return load<uint32_t>(from);
    }
}

tl::unexpected<Error> bad_accessor(const Document& document,
                                   int accessor,
                                   const char* id,
                                   std::string message) {
    return fail(ExitCode::bad_data,
                id,
                document.at("accessors", static_cast<size_t>(accessor)),
                std::move(message));
}

/// A sparse accessor's replacements: which elements, in increasing order, and from where.
struct Replacements {
    std::vector<uint32_t> elements;
    std::vector<uint32_t> order;  ///< position of each in the stored values
    std::span<const std::byte> values;
};

Result<Replacements> read_replacements(const Document& document,
                                       const BufferStore& store,
                                       int accessor) {
    const GltfAccessor& record = document.accessors[static_cast<size_t>(accessor)];
    const GltfSparse& sparse = record.sparse;
    const uint64_t index_size = component_size(sparse.index_type);
    const auto indices = checked_span(view_bytes(document, store, sparse.index_view),
                                      packed_range(sparse.index_offset, sparse.count, index_size));
    const auto values =
        checked_span(view_bytes(document, store, sparse.value_view),
                     packed_range(sparse.value_offset, sparse.count, element_size(record)));
    if (!indices || !values) {
        return bad_accessor(document, accessor, "E-ACC-RANGE", "the sparse data leave their view");
    }
    Replacements out;
    out.values = *values;
    out.elements.resize(sparse.count);
    out.order.resize(sparse.count);
    for (size_t i = 0; i < out.elements.size(); ++i) {
        out.elements[i] = load_unsigned(indices->data() + i * index_size, sparse.index_type);
        out.order[i] = static_cast<uint32_t>(i);
        if (out.elements[i] >= record.count) {
            return bad_accessor(document,
                                accessor,
                                "E-ACC-SPARSE",
                                "sparse index " + std::to_string(i) + " is " +
                                    std::to_string(out.elements[i]) + ", but the count is " +
                                    std::to_string(record.count));
        }
    }
    if (!std::is_sorted(out.elements.begin(), out.elements.end())) {
        std::stable_sort(out.order.begin(), out.order.end(), [&](uint32_t a, uint32_t b) {
            return out.elements[a] < out.elements[b];
        });
        std::sort(out.elements.begin(), out.elements.end());
    }
    return out;
}

/// Overwrites the chosen elements that a sparse accessor replaces; the last of equal indices
/// counts.
void apply_replacements(const Replacements& replacements,
                        const GltfAccessor& accessor,
                        const ElementChoice& choice,
                        std::vector<float>& out) {
    const size_t width = component_count(accessor);
    const Elements from{replacements.values.data(),
                        element_size(accessor),
                        column_size(accessor),
                        accessor.rows,
                        accessor.columns};
    const auto write = [&](size_t replacement, size_t target) {
        const uint32_t value = replacements.order[replacement];
        const ElementChoice one{false, std::span(&value, 1)};
        convert(from, accessor, one, out.data() + target * width);
    };
    const std::vector<uint32_t>& elements = replacements.elements;
    if (choice.all) {
        for (size_t i = 0; i < elements.size(); ++i)
            write(i, elements[i]);
        return;
    }
    for (size_t target = 0; target < choice.elements.size(); ++target) {
        const auto after =
            std::upper_bound(elements.begin(), elements.end(), choice.elements[target]);
        if (after == elements.begin() || *(after - 1) != choice.elements[target]) continue;
        write(static_cast<size_t>(after - elements.begin()) - 1, target);
    }
}

std::string range_text(const ElementRange& range, uint64_t total) {
    return std::to_string(range.count) + " elements of " + std::to_string(range.element_size) +
           " bytes, one every " + std::to_string(range.stride) + ", from byte " +
           std::to_string(range.offset) + " leave the view of " + std::to_string(total) + " bytes";
}

}  // namespace

uint64_t element_size(const GltfAccessor& accessor) {
    return column_size(accessor) * static_cast<uint64_t>(accessor.columns);
}

size_t component_count(const GltfAccessor& accessor) {
    return static_cast<size_t>(accessor.rows) * static_cast<size_t>(accessor.columns);
}

std::string accessor_problem(const Document& document, const GltfAccessor& accessor) {
    if (accessor.view >= 0) {
        const ElementRange range = element_range(document, accessor);
        const uint64_t total = view_of(document, accessor.view).byte_length;
        if (range.stride < range.element_size) {
            return "elements of " + std::to_string(range.element_size) +
                   " bytes do not fit the view's stride of " + std::to_string(range.stride);
        }
        if (!range_extent(range, total)) return range_text(range, total);
    }
    const GltfSparse& sparse = accessor.sparse;
    if (sparse.count == 0) return {};
    const ElementRange indices =
        packed_range(sparse.index_offset, sparse.count, component_size(sparse.index_type));
    const ElementRange values =
        packed_range(sparse.value_offset, sparse.count, element_size(accessor));
    const uint64_t index_total = view_of(document, sparse.index_view).byte_length;
    const uint64_t value_total = view_of(document, sparse.value_view).byte_length;
    if (!range_extent(indices, index_total))
        return "sparse indices: " + range_text(indices, index_total);
    if (!range_extent(values, value_total))
        return "sparse values: " + range_text(values, value_total);
    return {};
}

bool accessor_is_misaligned(const Document& document, const GltfAccessor& accessor) {
    if (accessor.view < 0) return false;
    const uint64_t start = view_of(document, accessor.view).byte_offset + accessor.byte_offset;
    return start % component_size(accessor.component) != 0;
}

bool sparse_indices_increase(const Document& document, const BufferStore& store, int accessor) {
    const GltfSparse& sparse = document.accessors[static_cast<size_t>(accessor)].sparse;
    const uint64_t size = component_size(sparse.index_type);
    const auto bytes = checked_span(view_bytes(document, store, sparse.index_view),
                                    packed_range(sparse.index_offset, sparse.count, size));
    if (!bytes) return true;  // read_floats reports it
    for (uint64_t i = 1; i < sparse.count; ++i) {
        const std::byte* at = bytes->data() + i * size;
        if (load_unsigned(at - size, sparse.index_type) >= load_unsigned(at, sparse.index_type)) {
            return false;
        }
    }
    return true;
}

Result<std::vector<float>> read_floats(const Document& document,
                                       const BufferStore& store,
                                       int accessor,
                                       const ElementChoice& choice,
                                       std::span<const std::byte> packed) {
    const GltfAccessor& record = document.accessors[static_cast<size_t>(accessor)];
    const uint64_t count = choice.all ? record.count : choice.elements.size();
    const bool has_data = record.view >= 0 || !packed.empty();
    if (!has_data && record.count > largest_count_of_zeros) {
        return fail(ExitCode::refused,
                    "E-LIMIT-COUNT",
                    document.at("accessors", static_cast<size_t>(accessor)) + "/count",
                    std::to_string(record.count) + " elements without data; accepted are " +
                        std::to_string(largest_count_of_zeros));
    }
    std::vector<float> out;
    if (has_data) {
        const ElementRange range = packed.empty()
                                       ? element_range(document, record)
                                       : packed_range(0, record.count, element_size(record));
        const auto bytes =
            checked_span(packed.empty() ? view_bytes(document, store, record.view) : packed, range);
        if (!bytes) {
            return bad_accessor(document, accessor, "E-ACC-RANGE", "the buffer has too few data");
        }
        out.resize(count * component_count(record));
        const Elements from{
            bytes->data(), range.stride, column_size(record), record.rows, record.columns};
        convert(from, record, choice, out.data());
    } else {
        out.resize(count * component_count(record));
    }
    if (record.sparse.count == 0) return out;
    const Result<Replacements> replacements = read_replacements(document, store, accessor);
    if (!replacements) return fail(replacements.error());
    apply_replacements(*replacements, record, choice, out);
    return out;
}

Result<std::vector<uint32_t>> read_indices(const Document& document,
                                           const BufferStore& store,
                                           int accessor) {
    const GltfAccessor& record = document.accessors[static_cast<size_t>(accessor)];
    const bool integers = record.component == ComponentType::uint8 ||
                          record.component == ComponentType::uint16 ||
                          record.component == ComponentType::uint32;
    if (!integers || component_count(record) != 1 || record.normalized) {
        return bad_accessor(document,
                            accessor,
                            "E-ACC-TYPE",
                            "vertex indices must be SCALAR, of 8, 16 or 32 unsigned bits, and not "
                            "normalized");
    }
    std::vector<uint32_t> out(record.count);
    if (record.view >= 0) {
        const ElementRange range = element_range(document, record);
        const auto bytes = checked_span(view_bytes(document, store, record.view), range);
        if (!bytes) {
            return bad_accessor(document, accessor, "E-ACC-RANGE", "the buffer has too few data");
        }
        for (size_t i = 0; i < out.size(); ++i)
            out[i] = load_unsigned(bytes->data() + i * range.stride, record.component);
    }
    if (record.sparse.count == 0) return out;
    const Result<Replacements> replacements = read_replacements(document, store, accessor);
    if (!replacements) return fail(replacements.error());
    for (size_t i = 0; i < replacements->elements.size(); ++i) {
        const std::byte* value =
            replacements->values.data() + replacements->order[i] * element_size(record);
        out[replacements->elements[i]] = load_unsigned(value, record.component);
    }
    return out;
}

}  // namespace obscura::gltf
