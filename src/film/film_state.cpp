// film/film_state.cpp - a film in a file, finished areas or sums, and what its pixels depend on.
// SPDX-License-Identifier: Apache-2.0
#include "film/film_state.h"

#include "base/memory_budget.h"
#include "image/channel_planes.h"

#include <algorithm>
#include <cstring>
#include <span>
#include <string_view>

namespace obscura {

namespace {

constexpr std::string_view magic = "OBSFILM6";

/// Calls `use(first float, count)` for each row of the areas, image by image.
template <typename AnyFilm, typename Use>
void for_rows(AnyFilm& film, std::span<const FilmArea> areas, const Use& use) {
    const auto rows = [&](auto& pixels, const ChannelPlane& plane, const FilmArea& area) {
        for (int y = area.y; y < area.y + area.height; ++y) {
            const size_t first = static_cast<size_t>(y) * static_cast<size_t>(film.width) +
                                 static_cast<size_t>(area.x);
            use(pixels.data() + plane.first_value + first * plane.channels,
                static_cast<size_t>(area.width) * plane.channels);
        }
    };
    for (const FilmArea& area : areas) {
        rows(film.pixels, ChannelPlane{0, film.channels.size(), 0}, area);
        for (auto& layer : film.layers) {
            const size_t channels = layer.layer.channels.size();
            for_planes(channels, layer.pixels.size() / channels, [&](const ChannelPlane& plane) {
                rows(layer.pixels, plane, area);
            });
        }
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
    if (part.of != PartOf::rows && part.of != PartOf::samples) return false;
    if (head.target_samples < (part.of == PartOf::samples ? 1 : 0)) return false;
    if (head.width < 1 || head.height < 1) return false;
    const auto lies_in = [](int first, int count, int all) {
        return first >= 0 && count > 0 && count <= all && first <= all - count;
    };
    return std::all_of(head.areas.begin(), head.areas.end(), [&](const FilmArea& area) {
        return lies_in(area.x, area.width, head.width) && lies_in(area.y, area.height, head.height);
    });
}

FilmStateHead read_head(StateReader& reader) {
    FilmStateHead head;
    head.part.index = reader.integer();
    head.part.count = reader.integer();
    head.part.of = static_cast<PartOf>(reader.integer());
    head.options = reader.texts();
    head.facts = reader.texts();
    for (uint64_t& counter : head.counters)
        counter = reader.number();
    head.width = reader.integer();
    head.height = reader.integer();
    head.images = reader.texts();
    head.target_samples = reader.integer();
    head.is_adaptive = reader.number() != 0;
    for (uint64_t left = reader.number(); left > 0 && reader.good(); --left) {
        FilmArea area;
        for (int* const one : {&area.x, &area.y, &area.width, &area.height})
            *one = reader.integer();
        head.areas.push_back(area);
    }
    return head;
}

/// Writes a file with what `put_rest` puts behind the head.
Result<void> write_state(const std::filesystem::path& file,
                         const FilmStateHead& head,
                         const Film& film,
                         const std::function<void(StateWriter&)>& put_rest) {
    return write_pieces_atomically(file, [&](const ByteSink& sink) {
        StateWriter out(sink);
        out.put(magic.data(), magic.size());
        out.put_number(static_cast<uint64_t>(head.part.index));
        out.put_number(static_cast<uint64_t>(head.part.count));
        out.put_number(static_cast<uint64_t>(head.part.of));
        out.put_texts(head.options);
        out.put_texts(head.facts);
        for (const uint64_t counter : head.counters)
            out.put_number(counter);
        out.put_number(static_cast<uint64_t>(film.width));
        out.put_number(static_cast<uint64_t>(film.height));
        out.put_texts(images_of(film));
        out.put_number(static_cast<uint64_t>(head.target_samples));
        out.put_number(head.is_adaptive ? 1 : 0);
        out.put_number(head.areas.size());
        for (const FilmArea& area : head.areas) {
            for (const int one : {area.x, area.y, area.width, area.height})
                out.put_number(static_cast<uint64_t>(one));
        }
        put_rest(out);
        return out.finish();
    });
}

/// Reads a file: the head, and where there is a film, with `take_rest` what is behind it.
Result<FilmStateHead> read_state(
    const std::filesystem::path& file,
    const Film* film,
    const std::function<void(const FilmStateHead&, StateReader&)>& take_rest) {
    MemoryCharge charge;
    const auto take = [&](uint64_t bytes) -> Result<void> {
        Result<MemoryCharge> taken =
            charge_memory(MemoryUse::film, file.filename().string(), bytes);
        if (!taken) return fail(std::move(taken.error()));
        charge = std::move(*taken);
        return {};
    };
    const FileBytes read = read_file_bytes(file, {UINT64_MAX, UINT64_MAX, take});
    if (read.refusal) return fail(*read.refusal);
    if (read.fault != FileFault::none)
        return damaged(file, "the file cannot be read: " + read.reason);
    const auto rest = checked(file, read.bytes);
    if (!rest) return fail(rest.error());
    StateReader reader(*rest);
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
    take_rest(head, reader);
    if (!reader.good() || !reader.at_end()) return damaged(file, "it has not its number of pixels");
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
    if (part.count == 1 || part.of == PartOf::samples) return {{0, height}};
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

SampleRange samples_of_part(int samples, const FilmPart& part) {
    if (part.of == PartOf::rows) return {0, samples};
    constexpr int64_t block = sum_block_samples;
    const int64_t blocks = (samples + block - 1) / block;
    const auto begin = [&](int64_t index) {
        return std::min<int64_t>(blocks * index / part.count * block, samples);
    };
    const int64_t first = begin(part.index);
    return {static_cast<uint32_t>(first), static_cast<int>(begin(part.index + 1) - first)};
}

std::vector<FilmArea> areas_of_part(int width, int height, const FilmPart& part) {
    std::vector<FilmArea> out;
    for (const RowRange& rows : rows_of_part(height, part))
        out.push_back({0, rows.first, width, rows.count});
    return out;
}

bool is_whole(const FilmStateHead& head) {
    return (head.target_samples > 0) == (head.part.of == PartOf::samples) &&
           pixels_in(head.areas) == pixels_in(areas_of_part(head.width, head.height, head.part));
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
    return write_state(file, head, film, [&](StateWriter& out) {
        for_rows(film, head.areas, [&](const float* row, size_t count) {
            out.put(row, count * sizeof(float));
        });
    });
}

Result<void> write_film_sums(const std::filesystem::path& file,
                             const FilmStateHead& head,
                             const Film& film,
                             const std::function<void(StateWriter&)>& put_sums) {
    return write_state(file, head, film, put_sums);
}

Result<FilmStateHead> read_film_state(const std::filesystem::path& file, Film* film) {
    return read_state(file, film, [&](const FilmStateHead& head, StateReader& reader) {
        for_rows(*film, head.areas, [&](float* row, size_t count) {
            reader.take(row, count * sizeof(float));
        });
    });
}

Result<FilmStateHead> read_film_sums(const std::filesystem::path& file,
                                     const Film& film,
                                     const std::function<void(StateReader&)>& take_sums) {
    return read_state(file, &film, [&](const FilmStateHead& /*head*/, StateReader& reader) {
        take_sums(reader);
    });
}

Film copy_areas(const Film& film, std::span<const FilmArea> areas) {
    Film out;
    out.width = film.width;
    out.height = film.height;
    out.channels = film.channels;
    out.part_of = film.part_of;
    out.pixels = zero_array<float>(film.pixels.size());
    for (const FilmLayer& layer : film.layers)
        out.layers.push_back({layer.layer, zero_array<float>(layer.pixels.size()), layer.names});
    std::vector<const float*> from;
    for_rows(film, areas, [&](const float* row, size_t /*count*/) { from.push_back(row); });
    auto next = from.begin();
    for_rows(out, areas, [&](float* row, size_t count) { std::copy_n(*next++, count, row); });
    return out;
}

}  // namespace obscura
