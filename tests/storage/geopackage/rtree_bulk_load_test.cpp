// SQLite reads, checks and edits the R-trees that we write as its own.

#include "storage/geopackage/rtree_bulk_load.hpp"
#include "support/files/files.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <random>

namespace macadam {
namespace {

using testing::test_folder;

struct Row {
    std::int64_t id;
    GeoBox box;
};

double anywhere(std::mt19937_64& random, double from, double to) {
    return std::uniform_real_distribution{from, to}(random);
}

/// Some in a crowd, some alone, some no more than a point; on both sides of 0.
std::vector<Row> made_up_rows(std::size_t count) {
    std::mt19937_64 random{count};
    std::vector<Row> rows;
    for (std::size_t i = 0; i < count; ++i) {
        const bool crowd = i % 3 == 0;
        const double west = crowd ? anywhere(random, 0.1, 0.11) : anywhere(random, -170, 170);
        const double south = crowd ? anywhere(random, 0.1, 0.11) : anywhere(random, -80, 80);
        const double size = i % 5 == 0 ? 0 : anywhere(random, 0, 0.003);
        rows.push_back({static_cast<std::int64_t>(3 * i + 7),
                        {.west_deg = west,
                         .south_deg = south,
                         .east_deg = west + size,
                         .north_deg = south + size}});
    }
    return rows;
}

Database made_of(const std::filesystem::path& file, const std::vector<Row>& rows) {
    Database database{file, Database::Access::create};
    database.run("CREATE VIRTUAL TABLE place USING rtree(id, minx, maxx, miny, maxy)");
    RtreeBulkLoad boxes;
    for (const auto& [id, box] : rows) {
        boxes.add(id, box);
    }
    std::move(boxes).write_to(database, "place");
    return database;
}

std::string checked(Database& database) {
    auto check = database.prepare("SELECT rtreecheck('place')");
    check.step();
    return check.text(0);
}

std::vector<std::int64_t> found_in(Database& database, const GeoBox& box) {
    auto select = database.prepare("SELECT id FROM place WHERE maxx >= ? AND minx <= ?"
                                   " AND maxy >= ? AND miny <= ? ORDER BY id");
    std::vector<std::int64_t> ids;
    for (select.bind(box.west_deg, box.east_deg, box.south_deg, box.north_deg); select.step();) {
        ids.push_back(select.integer(0));
    }
    return ids;
}

std::vector<std::int64_t> truly_in(const std::vector<Row>& rows, const GeoBox& box) {
    std::vector<std::int64_t> ids;
    for (const auto& [id, of] : rows) {
        if (of.east_deg >= box.west_deg && of.west_deg <= box.east_deg &&
            of.north_deg >= box.south_deg && of.south_deg <= box.north_deg) {
            ids.push_back(id);
        }
    }
    return ids;
}

std::vector<GeoBox> questions() {
    std::mt19937_64 random{5};
    std::vector<GeoBox> boxes{{-180, -90, 180, 90}, {0.1, 0.1, 0.11, 0.11}};
    for (int i = 0; i < 20; ++i) {
        const double west = anywhere(random, -170, 160), south = anywhere(random, -80, 70);
        boxes.push_back({west, south, west + anywhere(random, 0, 40), south + 10});
        const double near = anywhere(random, 0.1, 0.11);
        boxes.push_back({near, near, near + 0.001, near + 0.002});
    }
    return boxes;
}

/// Limits are kept as floats that are never inside the box: nothing is lost, and what is found
/// beside is next to the border.
void expect_answers(Database& database, const std::vector<Row>& rows) {
    constexpr double float_step_deg = 2e-5; // of 180
    for (const auto& box : questions()) {
        const auto found = found_in(database, box);
        const auto least = truly_in(rows, box);
        const auto most = truly_in(rows,
                                   {box.west_deg - float_step_deg,
                                    box.south_deg - float_step_deg,
                                    box.east_deg + float_step_deg,
                                    box.north_deg + float_step_deg});
        EXPECT_TRUE(std::ranges::includes(found, least));
        EXPECT_TRUE(std::ranges::includes(most, found));
    }
}

TEST(RtreeBulkLoad, IsSoundWithAnyNumberOfRows) {
    // A node holds 51; around that, its square, and with a third level.
    for (const std::size_t count : {0U, 1U, 51U, 52U, 103U, 2601U, 2602U, 6000U}) {
        const auto rows = made_up_rows(count);
        auto database = made_of(test_folder() / "a.db", rows);
        EXPECT_EQ(checked(database), "ok") << count << " rows";
        expect_answers(database, rows);
    }
}

TEST(RtreeBulkLoad, HasFullNodes) {
    auto database = made_of(test_folder() / "a.db", made_up_rows(2601));
    // 51 x 51 of them would fit; chunks and their last nodes cost some.
    EXPECT_LE(database.number("SELECT count(*) FROM place_node"), 60);
}

TEST(RtreeBulkLoad, CanBeEditedAsAnyOther) {
    auto rows = made_up_rows(3000);
    auto database = made_of(test_folder() / "a.db", rows);
    auto insert = database.prepare("INSERT INTO place VALUES (?, ?, ?, ?, ?)");
    for (std::int64_t id = 100'000; id < 100'500; ++id) {
        const double at = 0.1 + 1e-5 * static_cast<double>(id - 100'000);
        insert.run(id, at, at, at, at);
        rows.push_back({id, {.west_deg = at, .south_deg = at, .east_deg = at, .north_deg = at}});
    }
    database.run("DELETE FROM place WHERE id < 6000");
    std::erase_if(rows, [](const Row& row) { return row.id < 6000; });
    EXPECT_EQ(checked(database), "ok");
    expect_answers(database, rows);
}

} // namespace
} // namespace macadam
