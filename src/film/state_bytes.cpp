// film/state_bytes.cpp - numbers, texts and arrays of a film's state as bytes of a file, and back.
// SPDX-License-Identifier: Apache-2.0
#include "film/state_bytes.h"

#include <cstring>

namespace obscura {

namespace {

/// How numbers are put.
enum class PutAs : uint64_t { zero, floats, doubles };

PutAs shortest(const std::vector<double>& numbers) {
    auto out = PutAs::zero;
    for (const double number : numbers) {
        // By bits: a zero may have a sign.
        const auto same = std::bit_cast<uint64_t>(static_cast<double>(static_cast<float>(number)));
        if (same != std::bit_cast<uint64_t>(number)) return PutAs::doubles;
        if (same != 0) out = PutAs::floats;
    }
    return out;
}

}  // namespace

void StateWriter::put(const void* data, size_t size) {
    const auto* const bytes = static_cast<const std::byte*>(data);
    block_.insert(block_.end(), bytes, bytes + size);
    if (sink_ != nullptr && block_.size() >= block_size) flush();
}

void StateWriter::put_texts(const NamedTexts& texts) {
    put_number(texts.size());
    for (const auto& [name, text] : texts) {
        for (const std::string* one : {&name, &text}) {
            put_number(one->size());
            put(one->data(), one->size());
        }
    }
}

void StateWriter::put_doubles(const std::vector<double>& numbers) {
    const PutAs as = shortest(numbers);
    put_number(static_cast<uint64_t>(as));
    if (as == PutAs::doubles) put(numbers.data(), numbers.size() * sizeof(double));
    if (as != PutAs::floats) return;
    std::vector<float> floats(numbers.size());
    std::transform(numbers.begin(), numbers.end(), floats.begin(), [](double number) {
        return static_cast<float>(number);
    });
    put(floats.data(), floats.size() * sizeof(float));
}

Result<void> StateWriter::finish() {
    flush();
    put_number(sum_.value());
    flush();
    return done_;
}

void StateWriter::flush() {
    sum_.add(block_);
    if (done_) done_ = (*sink_)(block_);
    block_.clear();
}

void StateReader::take(void* out, uint64_t size) {
    if (size == 0) return;
    good_ = good_ && size <= rest_.size();
    if (!good_) {
        std::memset(out, 0, size);
        return;
    }
    std::memcpy(out, rest_.data(), size);
    rest_ = rest_.subspan(size);
}

void StateReader::take_doubles(std::vector<double>& out) {
    const auto as = static_cast<PutAs>(number());
    if (as == PutAs::doubles) return take(out.data(), out.size() * sizeof(double));
    std::vector<float> floats(out.size(), 0.0f);
    if (as == PutAs::floats) take(floats.data(), floats.size() * sizeof(float));
    std::copy(floats.begin(), floats.end(), out.begin());
}

std::string StateReader::text() {
    const uint64_t size = number();
    good_ = good_ && size <= rest_.size();
    std::string out(good_ ? size : 0, '\0');
    take(out.data(), out.size());
    return out;
}

NamedTexts StateReader::texts() {
    NamedTexts out;
    for (uint64_t left = number(); left > 0 && good_; --left) {
        std::string name = text();
        out.emplace_back(std::move(name), text());
    }
    return out;
}

}  // namespace obscura
