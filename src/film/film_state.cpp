// film/film_state.cpp - finished areas of a film in a file, with what their pixels depend on.
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

constexpr std::string_view magic = "OBSFILM2";

/// Hands pieces to a file in large blocks, with their checksum behind them.
class Writer {
public:
    explicit Writer(const ByteSink& sink) : sink_(sink) { block_.reserve(block_size); }

    void put(const void* data, size_t size) {
        const auto* const bytes = static_cast<const std::byte*>(data);
        block_.insert(block_.end(), bytes, bytes + size);
        if (block_.size() >= block_size) flush();
    }
    void put_number(uint64_t number) { put(&number, sizeof(number)); }
    void put_texts(const NamedTexts& texts) {
        put_number(texts.size());
        for (const auto& [name, text] : texts) {
            for (const std::string* one : {&name, &text}) {
                put_number(one->size());
                put(one->data(), one->size());
            }
        }
    }
    Result<void> finish() {
        flush();
        put_number(sum_.value());
        flush();
        return done_;
    }

private:
    static constexpr size_t block_size = size_t{1} << 20;

    void flush() {
        sum_.add(block_);
        if (done_) done_ = sink_(block_);
        block_.clear();
    }

    const ByteSink& sink_;
    Bytes block_;
    RunningChecksum sum_;
    Result<void> done_ = {};
};

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

/// Calls `use(first float, count)` for each row of the areas, image by image.
template <typename AnyFilm, typename Use>
void for_rows(AnyFilm& film, std::span<const FilmArea> areas, const Use& use) {
    const auto rows = [&](auto& pixels, size_t channels, const FilmArea& area) {
        for (int y = area.y; y < area.y + area.height; ++y) {
            const size_t first = static_cast<size_t>(y) * static_cast<size_t>(film.width) +
                                 static_cast<size_t>(area.x);
            use(pixels.data() + first * channels, static_cast<size_t>(area.width) * channels);
        }
    };
    for (const FilmArea& area : areas) {
        rows(film.pixels, film.channels.size(), area);
        for (auto& layer : film.layers)
            rows(layer.pixels, layer.layer.channels.size(), area);
    }
}

tl::unexpected<Error> damaged(const std::filesystem::path& file, const std::string& message) {
    return fail(ExitCode::io_error, "E-PART-DAMAGED", file.string(), message);
}

/// The bytes between the magic and the checksum, which fits them.
Result<std::span<const std::byte>> checked(const std::filesystem::path& file,
                                           std::span<const std::byte> bytes) {
    constexpr size_t sum_size = sizeof(uint64_t);
    if (bytes.size() < magic.size() + sum_size) return damaged(file, "the file is cut off");
    if (std::memcmp(bytes.data(), magic.data(), magic.size()) != 0)
        return damaged(file, "it is no part of a picture of this version");
    const std::span<const std::byte> summed = bytes.first(bytes.size() - sum_size);
    uint64_t sum = 0;
    std::memcpy(&sum, bytes.data() + summed.size(), sum_size);
    if (sum == checksum(summed)) return summed.subspan(magic.size());
    return damaged(file,
                   "the checksum does not fit: the file is cut off, or bytes of it have changed");
}

/// True when a head names a part that there is, and areas that lie in its film.
bool is_well_formed(const FilmStateHead& head) {
    const FilmPart& part = head.part;
    if (part.index < 0 || part.index >= part.count || part.count > max_film_parts) return false;
    if (head.width < 1 || head.height < 1) return false;
    const auto lies_in = [](int first, int count, int all) {
        return first >= 0 && count > 0 && count <= all && first <= all - count;
    };
    return std::all_of(head.areas.begin(), head.areas.end(), [&](const FilmArea& area) {
        return lies_in(area.x, area.width, head.width) && lies_in(area.y, area.height, head.height);
    });
}

FilmStateHead read_head(Reader& reader) {
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
    for (uint64_t left = reader.number(); left > 0 && reader.good(); --left) {
        FilmArea area;
        for (int* const one : {&area.x, &area.y, &area.width, &area.height})
            *one = reader.integer();
        head.areas.push_back(area);
    }
    return head;
}

}  // namespace

int64_t pixels_in(std::span<const FilmArea> areas) {
    int64_t out = 0;
    for (const FilmArea& area : areas)
        out += int64_t{area.width} * area.height;
    return out;
}

std::vector<RowRange> rows_of_part(int height, const FilmPart& part) {
    constexpr int max_rows = 16;  // a tile is so high
    constexpr int bands_a_part = 4;
    if (part.count == 1) return {{0, height}};
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

std::vector<FilmArea> areas_of_part(int width, int height, const FilmPart& part) {
    std::vector<FilmArea> out;
    for (const RowRange& rows : rows_of_part(height, part))
        out.push_back({0, rows.first, width, rows.count});
    return out;
}

bool is_whole(const FilmStateHead& head) {
    return pixels_in(head.areas) == pixels_in(areas_of_part(head.width, head.height, head.part));
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
    return write_pieces_atomically(file, [&](const ByteSink& sink) {
        Writer out(sink);
        out.put(magic.data(), magic.size());
        out.put_number(static_cast<uint64_t>(head.part.index));
        out.put_number(static_cast<uint64_t>(head.part.count));
        out.put_texts(head.options);
        out.put_texts(head.facts);
        for (const uint64_t counter : head.counters)
            out.put_number(counter);
        out.put_number(static_cast<uint64_t>(film.width));
        out.put_number(static_cast<uint64_t>(film.height));
        out.put_texts(images_of(film));
        out.put_number(head.areas.size());
        for (const FilmArea& area : head.areas) {
            for (const int one : {area.x, area.y, area.width, area.height})
                out.put_number(static_cast<uint64_t>(one));
        }
        for_rows(film, head.areas, [&](const float* row, size_t count) {
            out.put(row, count * sizeof(float));
        });
        return out.finish();
    });
}

Result<FilmStateHead> read_film_state(const std::filesystem::path& file, Film* film) {
    const FileBytes read = read_file_bytes(file, {});
    if (read.fault != FileFault::none)
        return damaged(file, "the file cannot be read: " + read.reason);
    const auto rest = checked(file, read.bytes);
    if (!rest) return fail(rest.error());
    Reader reader(*rest);
    FilmStateHead head = read_head(reader);
    if (!reader.good() || !is_well_formed(head))
        return damaged(file, "its head is not well formed");
    if (film == nullptr) return head;
    if (film->width != head.width || film->height != head.height ||
        images_of(*film) != head.images) {
        return fail(ExitCode::configuration,
                    "E-PART-MIX",
                    file.string(),
                    "its picture has another size or other layers");
    }
    for_rows(*film, head.areas, [&](float* row, size_t count) {
        reader.take(row, count * sizeof(float));
    });
    if (!reader.good() || !reader.at_end()) return damaged(file, "it has not its number of pixels");
    return head;
}

Film copy_areas(const Film& film, std::span<const FilmArea> areas) {
    Film out;
    out.width = film.width;
    out.height = film.height;
    out.channels = film.channels;
    out.part_of = film.part_of;
    out.pixels.assign(film.pixels.size(), 0.0f);
    for (const FilmLayer& layer : film.layers) {
        out.layers.push_back({layer.layer, {}, layer.names});
        out.layers.back().pixels.assign(layer.pixels.size(), 0.0f);
    }
    const auto copy = [&](const UnsetArray<float>& from, UnsetArray<float>& pixels, size_t size) {
        for (const FilmArea& area : areas) {
            for (int y = area.y; y < area.y + area.height; ++y) {
                const size_t first =
                    size * (static_cast<size_t>(y) * static_cast<size_t>(film.width) +
                            static_cast<size_t>(area.x));
                std::copy_n(from.data() + first,
                            size * static_cast<size_t>(area.width),
                            pixels.data() + first);
            }
        }
    };
    copy(film.pixels, out.pixels, film.channels.size());
    for (size_t i = 0; i < film.layers.size(); ++i)
        copy(film.layers[i].pixels, out.layers[i].pixels, film.layers[i].layer.channels.size());
    return out;
}

}  // namespace obscura
