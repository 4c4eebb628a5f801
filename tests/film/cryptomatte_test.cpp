// tests/film/cryptomatte_test.cpp - Cryptomatte ids, metadata, ranks, and mattes decoded from them.
// SPDX-License-Identifier: Apache-2.0
#include "film/cryptomatte.h"

#include "base/json/json.h"
#include "film/murmur_hash.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <random>

namespace obscura {
namespace {

const std::string cyrillic_plane = "\xD1\x80\xD0\xB0\xD0\xB2\xD0\xBD\xD0\xB8\xD0\xBD\xD0\xB0";
const std::string german_girl =
    "m\xC3\xA4"
    "dchen";

struct KnownId {
    std::string name;
    float id;
};

/// cryptomatte_utilities_tests.py of Psyop/Cryptomatte, CryptoHashing.
const KnownId known_ids[] = {
    {"hello", 6.0705627102400005616e-17f},
    {"cube", -4.08461912519e+15f},
    {"sphere", 2.79018604383e+15f},
    {"plane", 3.66557617593e-11f},
    {cyrillic_plane, -1.3192631212399999468e-25f},
    {german_girl, 6.2361298211599995797e+25f},
};

struct KnownHash {
    std::string name;
    uint32_t hash;
};

/// The specification, section "Metadata", and the manifests of Psyop/Cryptomatte's sample images.
const KnownHash known_hashes[] = {
    {"bunny", 0x13851a76},
    {"default", 0x42c9679f},
    {"bunny_porcelain_mat", 0xb24b26d4},
    {"leftAsset", 0xce406a47},
    {"flowerA.flowerA_petal1.:2261", 0x00af91ae},
    {"plant.smallStalk2.:80", 0x7f0488eb},
};

/// From the same manifests; an exponent of 0 became 1, one of 255 became 254.
const KnownHash known_repaired_hashes[] = {
    {"plant.smallStalk2.:453", 0x00c117e9},
    {"plant.smallStalk2.:735", 0x80e3f610},
    {"flowerA.flowerA_petal1.:1065", 0x7f0e5296},
    {"plant.smallStalk2.:585", 0xff40292d},
};

TEST(CryptomatteHash, GivesThePublishedIds) {
    for (const KnownId& known : known_ids)
        EXPECT_EQ(cryptomatte_id(cryptomatte_hash(known.name)), known.id) << known.name;
    for (const KnownHash& known : known_hashes) {
        EXPECT_EQ(cryptomatte_hash(known.name), known.hash) << known.name;
        EXPECT_EQ(murmur_hash(known.name), known.hash) << known.name;
    }
    for (const KnownHash& known : known_repaired_hashes) {
        EXPECT_EQ(cryptomatte_hash(known.name), known.hash) << known.name;
        EXPECT_NE(murmur_hash(known.name), known.hash) << known.name;
    }
}

/// As the specification's example code says it: the exponent is clamped to [1, 254].
uint32_t with_clamped_exponent(uint32_t hash) {
    const uint32_t sign_and_mantissa = hash & 0x807fffffu;
    const uint32_t exponent = std::clamp(hash >> 23 & 255u, 1u, 254u);
    return sign_and_mantissa | exponent << 23;
}

TEST(CryptomatteHash, IsAlwaysANormalFloat) {
    int denormals = 0;
    int nonfinite = 0;
    for (int i = 0; i < 20000; ++i) {
        const std::string name = "object" + std::to_string(i);
        const uint32_t raw = murmur_hash(name);
        const uint32_t hash = cryptomatte_hash(name);
        EXPECT_EQ(hash, with_clamped_exponent(raw)) << name;
        EXPECT_TRUE(std::isnormal(cryptomatte_id(hash))) << name;
        if (!std::isfinite(std::bit_cast<float>(raw))) {
            ++nonfinite;
        } else if (!std::isnormal(std::bit_cast<float>(raw))) {
            ++denormals;
        }
    }
    // Of 20000 names 78 are expected of each.
    EXPECT_GT(denormals, 40);
    EXPECT_GT(nonfinite, 40);
}

TEST(CryptomatteHash, OfNoNameIsNotThatOfNoObject) {
    EXPECT_EQ(murmur_hash(""), cryptomatte_no_object);
    EXPECT_NE(cryptomatte_hash(""), cryptomatte_no_object);
    EXPECT_TRUE(std::isnormal(cryptomatte_id(cryptomatte_hash(""))));
    EXPECT_EQ(cryptomatte_id(cryptomatte_no_object), 0.0f);
}

TEST(CryptomatteHash, KeepsWhiteSpaceAndForms) {
    const std::string composed = "\xC3\xA9";     // e with acute accent
    const std::string decomposed = "e\xCC\x81";  // the letter and a combining accent
    EXPECT_NE(cryptomatte_hash(" hello"), cryptomatte_hash("hello"));
    EXPECT_NE(cryptomatte_hash("hello\n"), cryptomatte_hash("hello"));
    EXPECT_NE(cryptomatte_hash("Hello"), cryptomatte_hash("hello"));
    EXPECT_NE(cryptomatte_hash(composed), cryptomatte_hash(decomposed));
    EXPECT_NE(cryptomatte_hash(std::string("a\0b", 3)), cryptomatte_hash("a"));
}

/// Keys in files of Arnold and Gaffer (crypto_object, crypto_material), and in those of Psyop.
TEST(CryptomatteKey, IsTheHashOfTheLayer) {
    EXPECT_EQ(cryptomatte_key("crypto_object"), "cryptomatte/f834d0a");
    EXPECT_EQ(cryptomatte_key("crypto_material"), "cryptomatte/bda530a");
    EXPECT_EQ(cryptomatte_key("uCryptoAsset"), "cryptomatte/d593dd7");
    EXPECT_EQ(cryptomatte_key("uCryptoObject"), "cryptomatte/ae93ba3");
}

TEST(CryptomatteChannels, HaveTwoRanksALayer) {
    EXPECT_EQ(cryptomatte_channels("crypto_object", 4),
              (std::vector<std::string>{"crypto_object00.r",
                                        "crypto_object00.g",
                                        "crypto_object00.b",
                                        "crypto_object00.a",
                                        "crypto_object01.r",
                                        "crypto_object01.g",
                                        "crypto_object01.b",
                                        "crypto_object01.a"}));
    EXPECT_EQ(cryptomatte_channels("m", default_cryptomatte_levels).size(), 12u);
    EXPECT_TRUE(cryptomatte_channels("m", 0).empty());
}

TEST(CryptomatteChannels, FillTheLastLayer) {
    EXPECT_EQ(cryptomatte_channels("m", 1), cryptomatte_channels("m", 2));
    EXPECT_EQ(cryptomatte_channels("m", 5), cryptomatte_channels("m", 6));
    EXPECT_EQ(cryptomatte_channels("m", 21).back(), "m10.a");
}

TEST(CryptomatteAttributes, AreThoseOfTheSpecification) {
    std::map<std::string, std::string> found;
    for (const auto& [name, text] : cryptomatte_attributes("crypto_object", "{}"))
        found[name] = text;
    EXPECT_EQ(found,
              (std::map<std::string, std::string>{
                  {"cryptomatte/f834d0a/name", "crypto_object"},
                  {"cryptomatte/f834d0a/hash", "MurmurHash3_32"},
                  {"cryptomatte/f834d0a/conversion", "uint32_to_float32"},
                  {"cryptomatte/f834d0a/manifest", "{}"},
              }));
    for (const auto& [name, text] : found)
        EXPECT_LE(name.size(), 31u) << name;
}

TEST(CryptomatteAttributes, NameTheFileInsteadOfTheManifest) {
    std::map<std::string, std::string> found;
    for (const auto& [name, text] : cryptomatte_file_attributes("crypto_object", "a.json"))
        found[name] = text;
    EXPECT_EQ(found.size(), 4u);
    EXPECT_EQ(found["cryptomatte/f834d0a/manif_file"], "a.json");
    EXPECT_EQ(found["cryptomatte/f834d0a/name"], "crypto_object");
}

/// Names that JSON must escape, and names that it must not change.
const std::vector<std::string> awkward_names = {"plain",
                                                "",
                                                " spaces \t",
                                                "quote\" and back\\slash",
                                                "line\nfeed",
                                                std::string("nul\0here", 8),
                                                "comma, [bracket] <angle>",
                                                "/path/to/mesh_0",
                                                cyrillic_plane,
                                                german_girl,
                                                "\xF0\x9F\x98\x80"};

std::map<std::string, uint32_t> read_manifest(const std::string& text) {
    const Json json = Json::parse(text, nullptr, false);
    EXPECT_TRUE(json.is_object()) << text;
    std::map<std::string, uint32_t> out;
    if (!json.is_object()) return out;
    for (const auto& [name, digits] : json.items()) {
        const auto hex = digits.get<std::string>();
        EXPECT_EQ(hex.size(), 8u) << hex;
        EXPECT_EQ(hex.find_first_not_of("0123456789abcdef"), std::string::npos) << hex;
        out[name] = static_cast<uint32_t>(std::stoul(hex, nullptr, 16));
    }
    return out;
}

TEST(CryptomatteManifest, ReadsBackTheSame) {
    for (const std::string& text :
         {cryptomatte_manifest(awkward_names), cryptomatte_manifest_document(awkward_names)}) {
        const std::map<std::string, uint32_t> found = read_manifest(text);
        EXPECT_EQ(found.size(), awkward_names.size());
        for (const std::string& name : awkward_names) {
            ASSERT_TRUE(found.contains(name)) << name;
            EXPECT_EQ(found.at(name), cryptomatte_hash(name)) << name;
        }
    }
}

/// Byte for byte as Psyop/Cryptomatte's sidecar_manifest.crypto_asset.json has them.
TEST(CryptomatteManifest, IsSortedAndOnOneLine) {
    const std::vector<std::string> names{"rightAsset", "default_555", "default", "rightAsset"};
    EXPECT_EQ(cryptomatte_manifest(names),
              R"({"default":"42c9679f","default_555":"56c1f4ca","rightAsset":"8f3ccbde"})");
    EXPECT_EQ(cryptomatte_manifest_document(names),
              "{\n  \"default\": \"42c9679f\",\n  \"default_555\": \"56c1f4ca\",\n"
              "  \"rightAsset\": \"8f3ccbde\"\n}\n");
    EXPECT_EQ(cryptomatte_manifest({}), "{}");
}

TEST(CryptomatteManifest, IsUtf8WhateverTheNamesAre) {
    const std::vector<std::string> names{"bad\xFFname"};
    const std::map<std::string, uint32_t> found = read_manifest(cryptomatte_manifest(names));
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found.begin()->first, "bad\xEF\xBF\xBDname");
    EXPECT_EQ(found.begin()->second, cryptomatte_hash(names[0]));
}

/// Headers and terminals take control characters out of texts: there must be none left to take.
TEST(CryptomatteManifest, HasNoControlCharacters) {
    const std::string name = std::string("\x01\x1F\x7F") + "\xC2\x80\xC2\x9F";
    const std::string text = cryptomatte_manifest(std::vector<std::string>{name});
    EXPECT_EQ(text.substr(0, text.find(':')), R"({"\u0001\u001f\u007f\u0080\u009f")");
    EXPECT_EQ(read_manifest(text).at(name), cryptomatte_hash(name));
}

std::vector<float> ranks_of(const std::vector<uint32_t>& hashes, uint32_t samples, size_t levels) {
    CryptomattePixel pixel;
    for (const uint32_t hash : hashes)
        pixel.add(hash, 1);
    std::vector<float> out(2 * levels, -1.0f);
    pixel.write_ranks(samples, out);
    return out;
}

constexpr uint32_t a = 0x40000001;
constexpr uint32_t b = 0x40000002;
constexpr uint32_t c = 0xc0000003;

TEST(CryptomattePixel, RanksByCoverage) {
    EXPECT_EQ(ranks_of({a, b, c, b, b, c, cryptomatte_no_object}, 8, 4),
              (std::vector<float>{cryptomatte_id(b),
                                  3.0f / 8,
                                  cryptomatte_id(c),
                                  2.0f / 8,
                                  cryptomatte_id(a),
                                  1.0f / 8,
                                  0.0f,
                                  0.0f}));
}

TEST(CryptomattePixel, RanksEqualCoverageByHash) {
    EXPECT_EQ(ranks_of({c, b, a, c, a, b}, 6, 3),
              (std::vector<float>{cryptomatte_id(a),
                                  1.0f / 3,
                                  cryptomatte_id(b),
                                  1.0f / 3,
                                  cryptomatte_id(c),
                                  1.0f / 3}));
}

TEST(CryptomattePixel, IsEmptyWithoutObjects) {
    const std::vector<float> zeros(4, 0.0f);
    EXPECT_EQ(ranks_of({}, 0, 2), zeros);
    EXPECT_EQ(ranks_of({}, 16, 2), zeros);
    EXPECT_EQ(ranks_of({cryptomatte_no_object, cryptomatte_no_object}, 2, 2), zeros);
}

TEST(CryptomattePixel, IsCoveredWhollyByOneObject) {
    EXPECT_EQ(ranks_of(std::vector<uint32_t>(1000, a), 1000, 1),
              (std::vector<float>{cryptomatte_id(a), 1.0f}));
}

TEST(CryptomattePixel, BelongsToWhatMostSamplesMeet) {
    CryptomattePixel pixel;
    const auto add = [&](uint32_t id, int times) {
        for (int i = 0; i < times; ++i)
            pixel.add(id, 1);
    };
    EXPECT_EQ(pixel.majority(4), cryptomatte_no_object) << "nothing but background";
    add(cryptomatte_no_object, 4);
    add(7, 3);
    EXPECT_EQ(pixel.majority(7), cryptomatte_no_object);
    add(7, 1);
    EXPECT_EQ(pixel.majority(8), 7U) << "before nothing, where they are equal";
    add(9, 2);
    add(5, 4);
    EXPECT_EQ(pixel.majority(14), 5U) << "the smaller of equals";
    for (uint32_t id = 20; id < 30; ++id)
        add(id, 3);
    add(25, 2);
    EXPECT_EQ(pixel.majority(46), 25U) << "beyond the first few ids";
}

TEST(CryptomattePixel, CanBeWrittenAgainAfterMoreSamples) {
    CryptomattePixel pixel;
    std::vector<float> ranks(2);
    pixel.add(a, 1);
    for (int round = 0; round < 2; ++round) {
        pixel.write_ranks(4, ranks);
        EXPECT_EQ(ranks[1], 0.25f);
    }
    pixel.add(a, 1);
    pixel.write_ranks(4, ranks);
    EXPECT_EQ(ranks[1], 0.5f);
}

/// Object i of `objects` is met i % 7 + 1 times: many have equal coverage.
std::vector<uint32_t> crowded_samples(size_t objects) {
    std::vector<uint32_t> out;
    for (size_t i = 0; i < objects; ++i) {
        const uint32_t hash = cryptomatte_hash("object" + std::to_string(i));
        out.insert(out.end(), i % 7 + 1, hash);
    }
    return out;
}

TEST(CryptomattePixel, DoesNotDependOnTheOrderOfSamples) {
    std::mt19937 random(1);
    for (const size_t objects : {1, 2, 3, 4, 5, 6, 8, 300}) {
        std::vector<uint32_t> samples = crowded_samples(objects);
        samples.insert(samples.end(), 5, cryptomatte_no_object);
        const auto count = static_cast<uint32_t>(samples.size());
        const std::vector<float> expected = ranks_of(samples, count, 310);
        for (int round = 0; round < 20; ++round) {
            std::shuffle(samples.begin(), samples.end(), random);
            // Bytes, because they are what the file holds.
            const std::vector<float> got = ranks_of(samples, count, 310);
            EXPECT_EQ(std::memcmp(got.data(), expected.data(), got.size() * sizeof(float)), 0)
                << objects;
        }
    }
}

/// Against counts in a map and a full sort.
TEST(CryptomattePixel, KeepsTheLargestOfHundreds) {
    std::vector<uint32_t> samples = crowded_samples(300);
    std::shuffle(samples.begin(), samples.end(), std::mt19937(2));
    std::map<uint32_t, int> counts;
    for (const uint32_t hash : samples)
        ++counts[hash];
    std::vector<std::pair<int, uint32_t>> sorted;
    for (const auto& [hash, count] : counts)
        sorted.emplace_back(-count, hash);
    std::sort(sorted.begin(), sorted.end());

    const auto total = static_cast<uint32_t>(samples.size());
    for (const size_t levels : {1, 2, 6, 50, 300}) {
        const std::vector<float> ranks = ranks_of(samples, total, levels);
        for (size_t i = 0; i < levels; ++i) {
            EXPECT_EQ(std::bit_cast<uint32_t>(ranks[2 * i]), sorted[i].second) << i;
            EXPECT_FLOAT_EQ(ranks[2 * i + 1],
                            static_cast<float>(-sorted[i].first) / static_cast<float>(total))
                << i;
        }
    }
}

/// What a compositor has: header attributes, channel names and one pixel's floats.
struct FilePixel {
    std::map<std::string, std::string> attributes;
    std::map<std::string, float> channels;
};

/// What a layer's attributes begin with, found by its name among those of all layers.
std::optional<std::string> find_prefix(const FilePixel& file, const std::string& layer) {
    const std::string begin = "cryptomatte/";
    const std::string end = "/name";
    for (const auto& [name, text] : file.attributes) {
        if (text != layer || !name.starts_with(begin) || !name.ends_with(end)) continue;
        const std::string prefix = name.substr(0, name.size() - end.size());
        EXPECT_LE(prefix.size(), begin.size() + 7) << "a key has 7 characters at most";
        return prefix + '/';
    }
    return std::nullopt;
}

/// The channel of the coverage that stands beside the id in `channel`; nothing when that is no
/// channel for ids of the layer: its name, digits, a dot and r or b.
std::optional<std::string> coverage_channel(const std::string& channel, const std::string& layer) {
    if (!channel.starts_with(layer)) return std::nullopt;
    const size_t dot = channel.find_first_not_of("0123456789", layer.size());
    if (dot == layer.size() || dot == std::string::npos) return std::nullopt;
    if (channel.substr(dot) == ".r") return channel.substr(0, dot) + ".g";
    if (channel.substr(dot) == ".b") return channel.substr(0, dot) + ".a";
    return std::nullopt;
}

/// The matte of a named object, as decoders make it: the coverage of all ranks that have its id.
float decode_matte(const FilePixel& file, const std::string& layer, const std::string& object) {
    const std::optional<std::string> prefix = find_prefix(file, layer);
    if (!prefix) return NAN;
    EXPECT_EQ(file.attributes.at(*prefix + "hash"), "MurmurHash3_32");
    EXPECT_EQ(file.attributes.at(*prefix + "conversion"), "uint32_to_float32");
    const auto manifest = read_manifest(file.attributes.at(*prefix + "manifest"));
    if (!manifest.contains(object)) return 0.0f;
    const auto id = std::bit_cast<float>(manifest.at(object));

    float matte = 0;
    for (const auto& [channel, value] : file.channels) {
        const std::optional<std::string> coverage = coverage_channel(channel, layer);
        if (coverage && value == id) matte += file.channels.at(*coverage);
    }
    return matte;
}

void add_layer(FilePixel& file,
               const std::string& layer,
               const std::map<std::string, int>& objects,
               uint32_t samples) {
    CryptomattePixel pixel;
    std::vector<std::string> names;
    for (const auto& [name, count] : objects) {
        names.push_back(name);
        for (int i = 0; i < count; ++i)
            pixel.add(cryptomatte_hash(name), 1);
    }
    const auto channels = cryptomatte_channels(layer, default_cryptomatte_levels);
    std::vector<float> ranks(channels.size());
    pixel.write_ranks(samples, ranks);
    for (size_t i = 0; i < channels.size(); ++i)
        file.channels[channels[i]] = ranks[i];
    for (const auto& [name, text] : cryptomatte_attributes(layer, cryptomatte_manifest(names)))
        file.attributes[name] = text;
}

TEST(Cryptomatte, MattesEqualTheCoverageThatWentIn) {
    const std::map<std::string, int> objects{{"bunny", 9},
                                             {"plant.smallStalk2.:453", 7},
                                             {"plant.smallStalk2.:585", 5},
                                             {german_girl, 3},
                                             {"quote\"", 2},
                                             {"", 1},
                                             {"hidden", 0}};
    const std::map<std::string, int> materials{{"bunny_porcelain_mat", 20}, {"glass", 12}};
    FilePixel file;
    add_layer(file, "crypto_object", objects, 32);
    add_layer(file, "crypto_material", materials, 32);
    for (const auto& [name, count] : objects)
        EXPECT_EQ(decode_matte(file, "crypto_object", name), static_cast<float>(count) / 32);
    for (const auto& [name, count] : materials)
        EXPECT_EQ(decode_matte(file, "crypto_material", name), static_cast<float>(count) / 32);
    EXPECT_EQ(decode_matte(file, "crypto_object", "glass"), 0.0f);
    EXPECT_TRUE(std::isnan(decode_matte(file, "crypto_asset", "bunny")));
}

TEST(Cryptomatte, CoverageBeyondTheLastRankIsDropped) {
    std::map<std::string, int> objects;
    for (int i = 1; i <= 9; ++i)
        objects["object" + std::to_string(i)] = i;
    FilePixel file;
    add_layer(file, "crypto_object", objects, 64);
    for (const auto& [name, count] : objects) {
        const bool kept = count > 9 - static_cast<int>(default_cryptomatte_levels);
        EXPECT_EQ(decode_matte(file, "crypto_object", name),
                  kept ? static_cast<float>(count) / 64 : 0.0f)
            << name;
    }
}

}  // namespace
}  // namespace obscura
