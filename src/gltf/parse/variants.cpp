// gltf/parse/variants.cpp - KHR_materials_variants: sets of alternative materials.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/variants.h"

#include "base/name_search.h"
#include "base/setting_names.h"

#include <algorithm>
#include <iterator>

namespace obscura::gltf {

namespace {

constexpr const char* variants_name = "KHR_materials_variants";

/// The material of a primitive in one variant; its own where no mapping names the variant.
int material_in(const GltfPrimitive& primitive, int variant) {
    if (primitive.assigned_material >= 0) return primitive.assigned_material;
    for (const GltfVariantMaterial& mapping : primitive.variants) {
        const std::vector<int>& in = mapping.variants;
        if (std::find(in.begin(), in.end(), variant) != in.end()) return mapping.material;
    }
    return primitive.own_material;
}

/// The number of a variant; -1 for the file's own materials, where the name is empty.
Result<int> find_variant(const std::string& name, const Document& document) {
    if (name.empty()) return -1;
    const std::vector<std::string>& all = document.variants;
    const auto found = std::find(all.begin(), all.end(), name);
    if (found != all.end()) return static_cast<int>(found - all.begin());
    std::string names;
    for (const std::string& other : all)
        names += (names.empty() ? "\"" : ", \"") + other + "\"";
    return fail(
        ExitCode::usage,
        "E-VARIANT-UNKNOWN",
        setting("variant"),
        "the asset has no variant \"" + name + "\"; it has " + (names.empty() ? "none" : names));
}

/// Calls `use` with every primitive.
template <typename Use>
void each_primitive(Document& document, const Use& use) {
    for (GltfMesh& mesh : document.meshes) {
        for (GltfPrimitive& primitive : mesh.primitives)
            use(primitive);
    }
}

/// The names, made different; "" stands for the file's own materials, and gets another one.
std::vector<std::string> names_to_choose_by(const std::vector<std::string>& given) {
    constexpr const char* nameless = "variant";
    std::vector<std::string> names;
    std::copy_if(given.begin(), given.end(), std::back_inserter(names), [](const auto& name) {
        return !name.empty();
    });
    names.resize(given.size(), nameless);  // behind the others, which keep theirs
    names = distinct_names(std::move(names));
    std::vector<std::string> out;
    size_t named = 0;
    size_t unnamed = given.size() - static_cast<size_t>(std::count(given.begin(), given.end(), ""));
    for (const std::string& name : given)
        out.push_back(names[name.empty() ? unnamed++ : named++]);
    return out;
}

}  // namespace

void read_variants(DocumentReading& reading) {
    if (!reading.root().has_extension(variants_name)) return;
    const ValueReader object = reading.root().extension(variants_name);
    std::vector<std::string> given;
    object.each("variants", [&](const ValueReader& variant, size_t) {
        variant.require("name");
        given.push_back(variant.text("name"));
    });
    if (reading.failed()) return;
    const std::vector<std::string> names = names_to_choose_by(given);
    for (size_t i = 0; i < names.size(); ++i) {
        if (names[i] == given[i]) continue;
        reading.log.warn(reading.document.at("/extensions/" + std::string(variants_name) +
                                             "/variants/" + std::to_string(i)),
                         (given[i].empty() ? "the variant has no name"
                                           : "the variant has the name of another one") +
                             std::string(": it is called \"") + names[i] + "\"");
    }
    reading.document.variants = names;
}

void read_variant_materials(const DocumentReading& reading,
                            const ModelElement& object,
                            GltfPrimitive& out) {
    if (!object.has_extension(variants_name)) return;
    const ValueReader extension = object.extension(variants_name);
    extension.each("mappings", [&](const ValueReader& mapping, size_t) {
        mapping.require("material");
        mapping.require("variants");
        GltfVariantMaterial entry;
        entry.material = mapping.index("material", reading.model.materials.size(), "material");
        entry.variants = mapping.indices("variants", reading.document.variants.size(), "variant");
        out.variants.push_back(std::move(entry));
    });
}

Result<void> choose_variant(const std::string& name, Document& document) {
    const Result<int> variant = find_variant(name, document);
    if (!variant) return fail(variant.error());
    each_primitive(document, [&](GltfPrimitive& primitive) {
        primitive.material = material_in(primitive, *variant);
        primitive.mode = primitive.own_mode;
    });
    return {};
}

Result<void> plan_variants(const std::vector<std::string>& names, Document& document) {
    std::vector<char> planned(document.materials.size(), 0);
    for (const std::string& name : names) {
        const Result<int> variant = find_variant(name, document);
        if (!variant) return fail(variant.error());
        each_primitive(document, [&](const GltfPrimitive& primitive) {
            const int material = material_in(primitive, *variant);
            if (material >= 0) planned[static_cast<size_t>(material)] = 1;
        });
    }
    document.planned_materials = std::move(planned);
    return {};
}

}  // namespace obscura::gltf
