// tests/math/table_record_test.cpp - a shared record and one record a lane read the same members.
// SPDX-License-Identifier: Apache-2.0
#include "math/table_record.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace obscura {
namespace {

/// A record that is a member of another.
struct Place {
    int32_t record = 0;
    float at[3] = {0, 0, 0};
};

struct Record {
    float size = 0;
    int32_t kind = 0;
    Place place;
    float grid[2][2] = {{0, 0}, {0, 0}};
    uint32_t flags = 0;
};
constexpr int words = static_cast<int>(sizeof(Record) / 4);

/// The same members in another order.
struct Reordered {
    uint32_t flags = 0;
    float grid[2][2] = {{0, 0}, {0, 0}};
    Place place;
    float size = 0;
    int32_t kind = 0;
};

static_assert(word_of<&Record::size> * 4 == offsetof(Record, size));
static_assert(word_of<&Record::kind> * 4 == offsetof(Record, kind));
static_assert(word_of<&Record::place> * 4 == offsetof(Record, place));
static_assert(word_of<&Record::place, &Place::at> * 4 ==
              offsetof(Record, place) + offsetof(Place, at));
static_assert(word_of<&Record::grid> * 4 == offsetof(Record, grid));
static_assert(word_of<&Record::flags> * 4 == offsetof(Record, flags));
static_assert(word_of<&Reordered::flags> == 0 && word_of<&Reordered::kind> == words - 1);

/// A different number in every member of every record.
template <typename R>
std::vector<R> table_of(int records) {
    std::vector<R> table(static_cast<size_t>(records));
    for (int i = 0; i < records; ++i) {
        R& r = table[static_cast<size_t>(i)];
        const int32_t start = 100 * i;
        const auto number = [&](int k) { return static_cast<float>(start + k) + 0.5F; };
        r.size = number(1);
        r.kind = start + 2;
        r.place = {start + 3, {number(4), number(5), number(6)}};
        r.grid[0][0] = number(7);
        r.grid[0][1] = number(8);
        r.grid[1][0] = number(9);
        r.grid[1][1] = number(10);
        r.flags = static_cast<uint32_t>(start) + 11;
    }
    return table;
}

/// Reads all members of the given records, one a lane, and compares with the table.
template <typename R>
void expect_records(const int32_t (&records)[16], bool shared) {
    const std::vector<R> table = table_of<R>(20);
    const TableRecord<Lanes, R> record(table.data(), load(records));
    EXPECT_EQ(record.shared(), shared);
    const auto expect = [&](const auto& lanes, const auto& value_of) {
        std::remove_cvref_t<decltype(value_of(table[0]))> read[16];
        store(read, lanes);
        for (int lane = 0; lane < lane_count; ++lane)
            EXPECT_EQ(read[lane], value_of(table[static_cast<size_t>(records[lane])]));
    };
    expect(record.template number<&R::size>(), [](const R& r) { return r.size; });
    expect(record.template integer<&R::kind>(), [](const R& r) { return r.kind; });
    expect(record.template integer<&R::flags>(),
           [](const R& r) { return static_cast<int32_t>(r.flags); });
    expect(record.template integer<&R::place, &Place::record>(),
           [](const R& r) { return r.place.record; });
    for (int k = 0; k < 3; ++k) {
        expect(record.template number<&R::place, &Place::at>(k),
               [&](const R& r) { return r.place.at[k]; });
    }
    const Four<Lanes> grid = record.template four_numbers<&R::grid>();
    expect(grid.x, [](const R& r) { return r.grid[0][0]; });
    expect(grid.y, [](const R& r) { return r.grid[0][1]; });
    expect(grid.w, [](const R& r) { return r.grid[1][1]; });
    const Vec3<Lanes> vector = record.template vector<&R::grid>();
    expect(vector.z, [](const R& r) { return r.grid[1][0]; });
}

TEST(TableRecord, LanesThatShareARecord) {
    int32_t records[16];
    for (const int32_t record : {0, 7, 19}) {
        std::fill_n(records, 16, record);
        expect_records<Record>(records, true);
        expect_records<Reordered>(records, true);
    }
}

TEST(TableRecord, OneLaneThatDiffersIsEnough) {
    for (int lane = 0; lane < lane_count; ++lane) {
        int32_t records[16];
        std::fill_n(records, 16, 3);
        records[lane] = 11;
        expect_records<Record>(records, false);
        expect_records<Reordered>(records, false);
    }
}

TEST(TableRecord, OneWordOfASharedRecordAndScalars) {
    const std::vector<Record> table = table_of<Record>(4);
    const TableRecord<Lanes, Record> lanes(table.data(), LanesI(2));
    EXPECT_EQ((lanes.one_integer<&Record::kind>()), 202);
    const TableRecord<double, Record> scalar(table.data(), 2);
    EXPECT_TRUE(scalar.shared());
    EXPECT_EQ((scalar.number<&Record::place, &Place::at>(0)), 204.5);
}

struct Levels {
    float first = 0;
    int32_t offset[4] = {0, 0, 0, 0};
};

TEST(TableRecord, AnotherElementForEveryLane) {
    const std::vector<Levels> table = {{0, {1, 2, 3, 4}}, {0, {5, 6, 7, 8}}};
    int32_t record[16];
    int32_t element[16];
    for (int lane = 0; lane < 16; ++lane) {
        record[lane] = lane % 2;
        element[lane] = lane / 2 % 4;
    }
    const TableRecord<Lanes, Levels> levels(table.data(), load(record));
    int32_t read[16];
    store(read, levels.varying_integer<&Levels::offset>(load(element)));
    for (int lane = 0; lane < lane_count; ++lane)
        EXPECT_EQ(read[lane], 1 + record[lane] * 4 + element[lane]);
}

}  // namespace
}  // namespace obscura
