#include "storage/sqlite/row_callback.hpp"

#include "support/files/files.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace macadam::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// Numbers from 1 to 5 with their squares, halves and names; the third has nothing else.
Database numbers_in(const std::filesystem::path& file) {
    Database database{file, Database::Access::create};
    register_row_callback(database);
    database.run("CREATE TABLE number (id INTEGER PRIMARY KEY, square INTEGER, half REAL, name)");
    auto insert = database.prepare("INSERT INTO number VALUES (?, ?, ?, ?)");
    for (const std::int64_t n : {5, 1, 4, 2}) {
        insert.run(n, n * n, static_cast<double>(n) / 2, "n" + std::to_string(n));
    }
    insert.run(std::int64_t{3}, std::nullopt, std::nullopt, std::nullopt);
    return database;
}

std::string select_from(std::string_view columns) {
    return select_visited(columns) + " FROM number WHERE id >= ? AND id <= ?";
}

TEST(RowCallback, TellTheValuesOfEachRowInTheOrderOfItsKey) {
    auto database = numbers_in(test_folder() / "a.db");
    auto select = database.prepare(select_from("id, square, half, name"));
    std::vector<std::string> told;
    const VisitRow visit = [&](const VisitedRow& row) {
        auto text = std::to_string(row.integer(0));
        for (const int column : {1, 2, 3}) {
            text += row.is_null(column) ? " -" : "";
        }
        text += " " + std::to_string(row.integer(1)) + " " + std::to_string(row.real(2)) + " ";
        told.push_back(text += row.blob(3));
    };
    RowCallback{visit}.run(select, std::int64_t{2}, std::int64_t{4});
    EXPECT_THAT(told, ElementsAre("2 4 1.000000 n2", "3 - - - 0 0.000000 ", "4 16 2.000000 n4"));
    RowCallback{visit}.run(select, std::int64_t{5}, std::int64_t{9});
    EXPECT_EQ(told.back(), "5 25 2.500000 n5");
    RowCallback{visit}.run(select, std::int64_t{6}, std::int64_t{9});
    EXPECT_EQ(told.size(), 4U);
}

TEST(RowCallback, EndWithWhatAVisitThrowsAndCanBeginAnew) {
    auto database = numbers_in(test_folder() / "a.db");
    auto select = database.prepare(select_from("id"));
    int visited = 0;
    const VisitRow fail = [&](const VisitedRow& row) {
        ++visited;
        if (row.integer(0) == 2) {
            throw std::out_of_range{"two"};
        }
    };
    for (const int begun : {1, 2}) {
        EXPECT_THAT([&] { RowCallback{fail}.run(select, std::int64_t{1}, std::int64_t{5}); },
                    ThrowsMessage<std::out_of_range>("two"));
        EXPECT_EQ(visited, 2 * begun);
    }
    const VisitRow count = [&](const VisitedRow&) { ++visited; };
    RowCallback{count}.run(select, std::int64_t{1}, std::int64_t{5});
    EXPECT_EQ(visited, 9);
}

TEST(RowCallback, CannotBeAskedForByOthers) {
    auto database = numbers_in(test_folder() / "a.db");
    for (const auto* const sql : {"SELECT visit_row(0, id) FROM number",
                                  "SELECT visit_row(id) FROM number",
                                  "SELECT visit_row(NULL, id) FROM number"}) {
        auto select = database.prepare(sql);
        EXPECT_THAT([&] { select.step(); }, ThrowsMessage<InputError>(HasSubstr("macadam alone")));
    }
    EXPECT_THROW(database.prepare("SELECT visit_row() FROM number").step(), InputError);
    database.run("CREATE VIEW visited AS SELECT visit_row(id, id) FROM number");
    EXPECT_THAT([&] { database.prepare("SELECT * FROM visited"); },
                ThrowsMessage<InputError>(HasSubstr("visit_row")));
}

} // namespace
} // namespace macadam::testing
