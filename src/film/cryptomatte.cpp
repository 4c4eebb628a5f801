// film/cryptomatte.cpp - Cryptomatte layers: ids of names, channels, metadata and coverage by rank.
// SPDX-License-Identifier: Apache-2.0
#include "film/cryptomatte.h"

#include "base/json/json.h"
#include "film/murmur_hash.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <map>
#include <utility>

namespace obscura {

namespace {

constexpr std::array channel_letters{'r', 'g', 'b', 'a'};
constexpr size_t key_digits = 7;

std::string hex_digits(uint32_t number) {
    std::string out(8, '0');
    for (size_t i = out.size(); i-- > 0; number >>= 4)
        out[i] = "0123456789abcdef"[number & 15u];
    return out;
}

/// Built at once from sorted names: adding to an ordered object searches all of its members.
Json manifest_json(std::span<const std::string> names) {
    std::map<std::string, std::string> sorted;
    for (const std::string& name : names)
        sorted.emplace(name, hex_digits(cryptomatte_hash(name)));
    return sorted;
}

std::vector<CryptomatteAttribute> attributes_with(std::string_view layer,
                                                  std::string_view manifest_name,
                                                  std::string manifest_text) {
    const std::string prefix = cryptomatte_key(layer) + '/';
    return {{prefix + "name", std::string(layer)},
            {prefix + "hash", "MurmurHash3_32"},
            {prefix + "conversion", "uint32_to_float32"},
            {prefix + std::string(manifest_name), std::move(manifest_text)}};
}

}  // namespace

uint32_t cryptomatte_hash(std::string_view name) noexcept {
    const uint32_t hash = murmur_hash(name);
    const uint32_t exponent = (hash >> 23) & 0xffu;
    return exponent == 0 || exponent == 0xffu ? hash ^ (1u << 23) : hash;
}

float cryptomatte_id(uint32_t hash) noexcept {
    return std::bit_cast<float>(hash);
}

std::string cryptomatte_key(std::string_view layer) {
    return "cryptomatte/" + hex_digits(cryptomatte_hash(layer)).substr(0, key_digits);
}

std::vector<std::string> cryptomatte_channels(std::string_view layer, size_t levels) {
    std::vector<std::string> out;
    for (size_t i = 0; 2 * i < levels; ++i) {
        const std::string number = (i < 10 ? "0" : "") + std::to_string(i);
        for (const char letter : channel_letters)
            out.push_back(std::string(layer) + number + '.' + letter);
    }
    return out;
}

std::string cryptomatte_manifest(std::span<const std::string> names) {
    return escape_json_controls(
        manifest_json(names).dump(-1, ' ', false, Json::error_handler_t::replace));
}

std::string cryptomatte_manifest_document(std::span<const std::string> names) {
    return json_document(manifest_json(names));
}

std::vector<CryptomatteAttribute> cryptomatte_attributes(std::string_view layer,
                                                         std::string manifest) {
    return attributes_with(layer, "manifest", std::move(manifest));
}

std::vector<CryptomatteAttribute> cryptomatte_file_attributes(std::string_view layer,
                                                              std::string file) {
    return attributes_with(layer, "manif_file", std::move(file));
}

bool CryptomattePixel::ranks_before(IdCount a, IdCount b) noexcept {
    return a.count != b.count ? a.count > b.count : a.hash < b.hash;
}

void CryptomattePixel::start_run(uint32_t hash) {
    end_run();
    run_ = {hash, 0};
}

void CryptomattePixel::end_run() {
    if (run_.hash == cryptomatte_no_object) return;
    for (IdCount& entry : few_) {
        if (entry.hash == cryptomatte_no_object) entry.hash = run_.hash;
        if (entry.hash == run_.hash) {
            entry.count += run_.count;
            return;
        }
    }
    const auto by_hash = [](IdCount entry, uint32_t hash) { return entry.hash < hash; };
    const auto place = std::lower_bound(others_.begin(), others_.end(), run_.hash, by_hash);
    if (place != others_.end() && place->hash == run_.hash) {
        place->count += run_.count;
    } else {
        others_.insert(place, run_);
    }
}

void CryptomattePixel::append(const CryptomattePixel& other) {
    const auto count = [this](IdCount entry) {
        if (entry.count > 0) add(entry.hash, entry.count);
    };
    count(other.run_);
    std::for_each(other.few_.begin(), other.few_.end(), count);
    std::for_each(other.others_.begin(), other.others_.end(), count);
}

/// The entry that follows `last` in the order of ranks; no object when there is none.
CryptomattePixel::IdCount CryptomattePixel::next_rank(IdCount last) const noexcept {
    IdCount next;
    const auto consider = [&](IdCount entry) {
        if (ranks_before(last, entry) && ranks_before(entry, next)) next = entry;
    };
    std::for_each(few_.begin(), few_.end(), consider);
    std::for_each(others_.begin(), others_.end(), consider);
    return next;
}

void CryptomattePixel::write_ranks(uint32_t samples, std::span<float> ranks) const {
    CryptomattePixel whole = *this;
    whole.end_run();
    IdCount last{cryptomatte_no_object, std::numeric_limits<uint32_t>::max()};
    for (size_t i = 0; i + 1 < ranks.size(); i += 2) {
        last = whole.next_rank(last);
        if (last.count == 0) {  // no more: the usual case after the first
            std::fill(ranks.begin() + static_cast<std::ptrdiff_t>(i), ranks.end(), 0.0f);
            return;
        }
        ranks[i] = cryptomatte_id(last.hash);
        ranks[i + 1] = static_cast<float>(static_cast<double>(last.count) / samples);
    }
}

uint32_t CryptomattePixel::majority(uint32_t samples) const {
    CryptomattePixel whole = *this;
    whole.end_run();
    uint32_t nothing = samples;
    for (const IdCount& entry : whole.few_)
        nothing -= entry.count;
    for (const IdCount& entry : whole.others_)
        nothing -= entry.count;
    const IdCount most =
        whole.next_rank({cryptomatte_no_object, std::numeric_limits<uint32_t>::max()});
    return most.count >= nothing ? most.hash : cryptomatte_no_object;
}

void CryptomattePixel::put(StateWriter& out) const {
    const auto used = static_cast<size_t>(
        std::find_if(few_.begin(), few_.end(), [](IdCount entry) { return entry.count == 0; }) -
        few_.begin());
    const auto used_byte = static_cast<uint8_t>(used);
    out.put(&run_, sizeof(run_));
    out.put(&used_byte, 1);
    out.put(few_.data(), used * sizeof(IdCount));
    if (used == few_.size()) out.put_array(others_);
}

void CryptomattePixel::take(StateReader& in) {
    uint8_t used = 0;
    in.take(&run_, sizeof(run_));
    in.take(&used, 1);
    few_ = {};
    others_.clear();
    in.take(few_.data(), std::min<size_t>(used, few_.size()) * sizeof(IdCount));
    if (used == few_.size()) in.take_new_array(others_);
}

}  // namespace obscura
