// tests/stages/tables_test.cpp - every member of the scene's tables is read from its offset.
// SPDX-License-Identifier: Apache-2.0
#include "math/table_record.h"
#include "scene/scene.h"
#include "shape/shape_record.h"

#include <gtest/gtest.h>

#include "support/random.h"
#include <array>
#include <bit>
#include <cstring>

namespace obscura::test {
namespace {

/// Records whose words are all different.
template <typename Record>
std::array<Record, 3> different_records() {
    Pcg32 random(7);
    std::array<Record, 3> records;
    for (Record& record : records) {
        std::array<uint32_t, sizeof(Record) / 4> words{};
        for (uint32_t& word : words)
            word = (random.next_uint() & 0xFFFFFU) | 0x3F800000U;  // a float in [1, 1.25)
        record = std::bit_cast<Record>(words);
    }
    return records;
}

/// Values written through the struct are read back by the member's name, element by element.
template <auto member, typename Record>
void expect_member(const std::array<Record, 3>& table) {
    for (int32_t k = 0; k < 3; ++k) {
        const TableRecord<float, Record> record(table.data(), k);
        const auto& value = table[static_cast<size_t>(k)].*member;
        using Element = ElementOf<member>;
        for (size_t i = 0; i < sizeof value / 4; ++i) {
            Element own;
            std::memcpy(&own, reinterpret_cast<const char*>(&value) + 4 * i, 4);
            const int element = static_cast<int>(i);
            if constexpr (std::is_same_v<Element, float>) {
                EXPECT_EQ(record.template number<member>(element), own) << word_of<member>;
            } else {
                EXPECT_EQ(record.template integer<member>(element), static_cast<int32_t>(own))
                    << word_of<member>;
            }
        }
    }
}

/// A record's members, and proof that they cover all its words.
template <typename Record, auto... members>
void expect_members() {
    const std::array<Record, 3> table = different_records<Record>();
    (expect_member<members>(table), ...);
    EXPECT_EQ((sizeof(MemberOf<members>) + ...), sizeof(Record)) << "a member is missing here";
}

/// The parts of a texture slot.
template <auto slot>
void expect_slot() {
    using Record = RecordOf<slot>;
    const std::array<Record, 3> table = different_records<Record>();
    for (int32_t k = 0; k < 3; ++k) {
        const TableRecord<float, Record> record(table.data(), k);
        const TextureSlot& own = table[static_cast<size_t>(k)].*slot;
        EXPECT_EQ((record.template integer<slot, &TextureSlot::texture>()), own.texture);
        EXPECT_EQ((record.template integer<slot, &TextureSlot::uv_set>()), own.uv_set);
        for (int i = 0; i < 6; ++i)
            EXPECT_EQ((record.template number<slot, &TextureSlot::uv_from_mesh>(i)),
                      own.uv_from_mesh[i]);
    }
}

TEST(Tables, EveryMemberOfAPrimitive) {
    using P = Primitive;
    expect_members<P,
                   &P::first_triangle,
                   &P::triangle_count,
                   &P::material,
                   &P::normal_base,
                   &P::tangent_base,
                   &P::color_base,
                   &P::uv_base,
                   &P::node,
                   &P::light_base,
                   &P::geometry,
                   &P::motion_base,
                   &P::motion_stride>();
}

TEST(Tables, EveryMemberOfAShapeAndATexture) {
    expect_members<ShapeRecord,
                   &ShapeRecord::kind,
                   &ShapeRecord::centre,
                   &ShapeRecord::size,
                   &ShapeRecord::k>();
    using T = TextureRecord;
    expect_members<T,
                   &T::width,
                   &T::height,
                   &T::levels,
                   &T::sampler,
                   &T::low_plane,
                   &T::level_offset>();
    using M = Medium;
    expect_members<M, &M::extinction, &M::ior, &M::albedo, &M::anisotropy>();
}

TEST(Tables, EveryMemberOfAnInstance) {
    using I = Instance;
    const std::array<I, 3> table = different_records<I>();
    expect_member<&I::mesh>(table);
    expect_member<&I::node>(table);
    expect_member<&I::mirrored>(table);
    expect_member<&I::light_base>(table);
    expect_member<&I::motion>(table);
    for (int32_t k = 0; k < 3; ++k) {
        const TableRecord<float, I> record(table.data(), k);
        const I& own = table[static_cast<size_t>(k)];
        for (int i = 0; i < 12; ++i) {
            EXPECT_EQ((record.number<&I::world_from_object, &Affinef::m>(i)),
                      own.world_from_object.m[i / 4][i % 4]);
            EXPECT_EQ((record.number<&I::object_from_world, &Affinef::m>(i)),
                      own.object_from_world.m[i / 4][i % 4]);
        }
    }
}

TEST(Tables, EveryMemberOfAMaterial) {
    using M = Material;
    const std::array<M, 3> table = different_records<M>();
    expect_member<&M::base_color>(table);
    expect_member<&M::metallic>(table);
    expect_member<&M::roughness>(table);
    expect_member<&M::normal_scale>(table);
    expect_member<&M::alpha_cutoff>(table);
    expect_member<&M::emission>(table);
    expect_member<&M::flags>(table);
    expect_member<&M::layers>(table);
    expect_member<&M::occlusion_strength>(table);
    expect_slot<&M::base_color_texture>();
    expect_slot<&M::metallic_roughness_texture>();
    expect_slot<&M::normal_texture>();
    expect_slot<&M::emissive_texture>();
    expect_slot<&M::occlusion_texture>();
}

TEST(Tables, MembersOfLayers) {
    using L = MaterialLayers;
    const std::array<L, 3> table = different_records<L>();
    expect_member<&L::ior>(table);
    expect_member<&L::specular_color>(table);
    expect_member<&L::thin_film_thickness_nm>(table);
    expect_member<&L::diffuse_transmission_color>(table);
    expect_member<&L::dispersion>(table);
    expect_member<&L::medium>(table);
    expect_slot<&L::specular_texture>();
    expect_slot<&L::clearcoat_normal_texture>();
    expect_slot<&L::diffuse_transmission_color_texture>();
}

}  // namespace
}  // namespace obscura::test
