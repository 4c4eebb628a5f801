// film/state_bytes.cpp - numbers, texts and arrays of a film's state as bytes of a file, and back.
// SPDX-License-Identifier: Apache-2.0
#include "film/state_bytes.h"

#include <cstring>

namespace obscura {

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
    good_ = good_ && size <= rest_.size();
    if (!good_ || size == 0) return;
    std::memcpy(out, rest_.data(), size);
    rest_ = rest_.subspan(size);
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
