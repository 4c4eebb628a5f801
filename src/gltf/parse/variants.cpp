// gltf/parse/variants.cpp - KHR_materials_variants: sets of alternative materials.
// SPDX-License-Identifier: Apache-2.0
#include "gltf/parse/variants.h"

#include "base/setting_names.h"

#include <algorithm>

namespace obscura::gltf {

namespace {

constexpr const char* variants_name = "KHR_materials_variants";

/// The material of a primitive in one variant; its own where no mapping names the variant.
int material_in(const GltfPrimitive& primitive, int variant) {
    for (const GltfVariantMaterial& mapping : primitive.variants) {
        const std::vector<int>& in = mapping.variants;
        if (std::find(in.begin(), in.end(), variant) != in.end()) return mapping.material;
    }
    return primitive.material;
}

}  // namespace

void read_variants(DocumentReading& reading) {
    if (!reading.root().has_extension(variants_name)) return;
    const ValueReader object = reading.root().extension(variants_name);
    object.each("variants", [&](const ValueReader& variant, size_t) {
        variant.require("name");
        reading.document.variants.push_back(variant.text("name"));
    });
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
    const auto found = std::find(document.variants.begin(), document.variants.end(), name);
    if (found == document.variants.end()) {
        std::string names;
        for (const std::string& other : document.variants)
            names += (names.empty() ? "\"" : ", \"") + other + "\"";
        return fail(ExitCode::usage,
                    "E-VARIANT-UNKNOWN",
                    setting("variant"),
                    "the asset has no variant \"" + name + "\"; it has " +
                        (names.empty() ? "none" : names));
    }
    const int variant = static_cast<int>(found - document.variants.begin());
    for (GltfMesh& mesh : document.meshes) {
        for (GltfPrimitive& primitive : mesh.primitives)
            primitive.material = material_in(primitive, variant);
    }
    return {};
}

}  // namespace obscura::gltf
