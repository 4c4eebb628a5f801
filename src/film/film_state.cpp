// film/film_state.cpp - finished rows of a film in a file, with what their pixels depend on.
// SPDX-License-Identifier: Apache-2.0
#include "film/film_state.h"

#include "base/atomic_file.h"
#include "base/checksum.h"
#include "base/file_bytes.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <span>
#include <string_view>

namespace obscura {

namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::string_view magic = "OBSFILM1";
constexpr size_t head_at = magic.size() + 2 * sizeof(uint64_t);  // behind size and checksum

void put(Bytes& out, const void* data, size_t size) {
    const auto* const bytes = static_cast<const std::byte*>(data);
    out.insert(out.end(), bytes, bytes + size);
}

void put_number(Bytes& out, uint64_t number) {
    put(out, &number, sizeof(number));
}

void put_texts(Bytes& out, const NamedTexts& texts) {
    put_number(out, texts.size());
    for (const auto& [name, text] : texts) {
        for (const std::string* one : {&name, &text}) {
            put_number(out, one->size());
            put(out, one->data(), one->size());
        }
    }
}

/// Reads what `put` wrote; past the end there are zeros, and `good` is false.
class Reader {
public:
    explicit Reader(std::span<const std::byte> bytes) : rest_(bytes) {}

    bool good() const { return good_; }
    bool at_end() const { return rest_.empty(); }

    void take(void* out, uint64_t size) {
        good_ = good_ && size <= rest_.size();
        if (!good_) return;
        std::memcpy(out, rest_.data(), size);
        rest_ = rest_.subspan(size);
    }
    uint64_t number() {
        uint64_t out = 0;
        take(&out, sizeof(out));
        return out;
    }
    int integer() { return static_cast<int>(number()); }
    std::string text() {
        const uint64_t size = number();
        good_ = good_ && size <= rest_.size();
        std::string out(good_ ? size : 0, '\0');
        take(out.data(), out.size());
        return out;
    }
    NamedTexts texts() {
        NamedTexts out;
        for (uint64_t left = number(); left > 0 && good_; --left) {
            std::string name = text();
            out.emplace_back(std::move(name), text());
        }
        return out;
    }

private:
    std::span<const std::byte> rest_;
    bool good_ = true;
};

/// Calls `use(first float, count)` for each row of the part, image by image.
template <typename AnyFilm, typename Use>
void for_rows(AnyFilm& film, const std::vector<RowRange>& rows, const Use& use) {
    const auto image = [&](auto& pixels, size_t channels) {
        const size_t row = static_cast<size_t>(film.width) * channels;
        for (const RowRange& range : rows)
            use(pixels.data() + static_cast<size_t>(range.first) * row,
                static_cast<size_t>(range.count) * row);
    };
    image(film.pixels, film.channels.size());
    for (auto& layer : film.layers)
        image(layer.pixels, layer.layer.channels.size());
}

tl::unexpected<Error> damaged(const std::filesystem::path& file, const std::string& message) {
    return fail(ExitCode::io_error, "E-PART-DAMAGED", file.string(), message);
}

/// The bytes behind size and checksum, which fit them.
Result<std::span<const std::byte>> checked(const std::filesystem::path& file,
                                           std::span<const std::byte> bytes) {
    Reader reader(bytes);
    std::string found(magic.size(), '\0');
    reader.take(found.data(), found.size());
    const uint64_t size = reader.number();
    const uint64_t sum = reader.number();
    if (!reader.good()) return damaged(file, "the part is cut off; render it again");
    if (found != magic) {
        return damaged(file, "it is no part of a picture of this version; render it again");
    }
    const std::span<const std::byte> rest = bytes.subspan(head_at);
    if (size != rest.size()) {
        return damaged(
            file,
            "the part is cut off, or something follows it: " + std::to_string(rest.size()) +
                " bytes instead of " + std::to_string(size) + "; render it again");
    }
    if (sum != checksum(rest)) {
        return damaged(file, "the checksum does not fit: bytes have changed; render it again");
    }
    return rest;
}

}  // namespace

std::vector<RowRange> rows_of_part(int height, const FilmPart& part) {
    constexpr int max_rows = 16;  // a tile is so high
    constexpr int bands_a_part = 4;
    int rows = max_rows;
    while (rows > 1 && int64_t{height} < int64_t{bands_a_part} * part.count * rows)
        rows /= 2;
    std::vector<RowRange> out;
    for (int64_t first = int64_t{part.index} * rows; first < height;
         first += int64_t{part.count} * rows) {
        const auto begin = static_cast<int>(first);
        out.push_back({begin, std::min(rows, height - begin)});
    }
    return out;
}

NamedTexts images_of(const Film& film) {
    const auto joined_names = [](const std::vector<std::string>& channels) {
        std::string out;
        for (const std::string& channel : channels)
            out += channel + " ";
        return out;
    };
    NamedTexts out = {{"", joined_names(film.channels)}};
    for (const FilmLayer& layer : film.layers)
        out.emplace_back(layer.layer.name, joined_names(layer.layer.channels));
    return out;
}

Result<void> write_film_state(const std::filesystem::path& file,
                              const FilmStateHead& head,
                              const Film& film) {
    Bytes out(head_at);
    put_number(out, static_cast<uint64_t>(head.part.index));
    put_number(out, static_cast<uint64_t>(head.part.count));
    put_texts(out, head.options);
    put_texts(out, head.facts);
    for (const uint64_t counter : head.counters)
        put_number(out, counter);
    put_number(out, static_cast<uint64_t>(film.width));
    put_number(out, static_cast<uint64_t>(film.height));
    put_texts(out, images_of(film));
    for_rows(film, rows_of_part(film.height, head.part), [&](const float* row, size_t count) {
        put(out, row, count * sizeof(float));
    });
    const std::array<uint64_t, 2> numbers = {out.size() - head_at,
                                             checksum(std::span(out).subspan(head_at))};
    std::memcpy(out.data(), magic.data(), magic.size());
    std::memcpy(out.data() + magic.size(), numbers.data(), sizeof(numbers));
    return write_file_atomically(file, out);
}

Result<FilmStateHead> read_film_state(const std::filesystem::path& file, Film* film) {
    const FileBytes read = read_file_bytes(file, {});
    if (read.fault != FileFault::none)
        return damaged(file, "the part cannot be read: " + read.reason);
    const auto rest = checked(file, read.bytes);
    if (!rest) return fail(rest.error());
    Reader reader(*rest);
    FilmStateHead head;
    head.part.index = reader.integer();
    head.part.count = reader.integer();
    head.options = reader.texts();
    head.facts = reader.texts();
    for (uint64_t& counter : head.counters)
        counter = reader.number();
    head.width = reader.integer();
    head.height = reader.integer();
    head.images = reader.texts();
    const FilmPart& part = head.part;
    if (!reader.good() || part.index < 0 || part.index >= part.count || part.count > max_film_parts)
        return damaged(file, "its head is not well formed");
    if (film == nullptr) return head;
    if (film->width != head.width || film->height != head.height ||
        images_of(*film) != head.images) {
        return fail(ExitCode::configuration,
                    "E-PART-MIX",
                    file.string(),
                    "its picture has another size or other layers");
    }
    for_rows(*film, rows_of_part(film->height, head.part), [&](float* row, size_t count) {
        reader.take(row, count * sizeof(float));
    });
    if (!reader.good() || !reader.at_end()) return damaged(file, "it has not its number of pixels");
    return head;
}

}  // namespace obscura
