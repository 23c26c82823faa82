// Which rows belong to a cut, the same whether it is made from a file or from a server.

#include "storage/store/copy/cut_out.hpp"

#include "storage/postgres/server_connection.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/store/privacy/privacy_key.hpp"
#include "storage/store/schema/schema_check.hpp"
#include "storage/store/server/copy/store_copy.hpp"
#include "support/files/files.hpp"
#include "support/program/postgres_server.hpp"
#include "support/roads/engine_world.hpp"
#include "support/roads/region_cuts.hpp"
#include "support/roads/store_world.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Names of tables with rows.
std::set<std::string> tables_in(const std::vector<std::string>& rows) {
    std::set<std::string> tables;
    for (const auto& row : rows) {
        tables.insert(row.substr(0, row.find('|')));
    }
    return tables;
}

/// Puts a row into each table that trips do not fill.
void fill_all_tables(const fs::path& file) {
    Database{file, Database::Access::write}.run(R"(
        INSERT INTO background VALUES (14, 8411, 5881, 0, x'00'), (8, 131, 91, 0, x'00');
        INSERT INTO place VALUES (1, 'Lyon', 0, 450000000, 50000000, 520000);
        INSERT INTO road_ref VALUES (1, 'D 12');
        INSERT INTO control_section VALUES ('a', 1, 'forward', 0, 100000, 2000, 50, NULL);
        INSERT INTO strip_dirty SELECT min(strip) FROM trace;
        INSERT INTO segment_dirty SELECT DISTINCT pass.segment FROM pass JOIN segment
            ON fid = pass.segment WHERE strip IN (SELECT strip FROM strip_dirty);
        INSERT INTO fusion_setting VALUES ('max_trips_per_car_month', 4);
        INSERT INTO calibration SELECT min(id), 1000000, 0, 10000, 3, 60 FROM vehicle;
        INSERT INTO calibration_period
            SELECT min(id), 0, NULL, 1000000, 0, 10000, 10000, 60, NULL, NULL, NULL FROM vehicle;
        INSERT INTO valid_from SELECT min(segment), 0 FROM pass;
        INSERT INTO forgotten VALUES ('mark');
        INSERT INTO publication VALUES (1, '2026-01', 3, 9, 10, 200, 0, 0, 4, 4);
        INSERT INTO published_state SELECT * FROM segment_state WHERE fid < 4;
        INSERT INTO published_until SELECT min(segment), 3 FROM pass;
        INSERT INTO published_pending SELECT segment, trip, occurrence FROM pass LIMIT 1;
        INSERT INTO published_figure SELECT min(segment), 0, 1, NULL, NULL, 2000, 50, 1900, 2100,
            NULL, NULL, 0, 0, 4, 4 FROM pass;
        INSERT INTO published_event SELECT min(segment), 0, 0, 1, 71000, 800, 40000, 5000, 500, 4, 4,
            4, NULL, NULL FROM pass;)");
}

/// Database in a file, and its copy on a server.
class CutsOfBothEngines : public ::testing::Test {
protected:
    void SetUp() override { import_rich_trips(*database_.import().trips, 4); }

    /// Cuts both and expects the same of them.
    void expect_same_cuts(const GeoBox& box) {
        const auto address = server_.new_database("roads");
        copy_to_server(database_.name(), address, {}, {});
        const auto of_file = cut_from(database_.name(), region_of(box), folder_ / "a.gpkg");
        const auto of_server = cut_from(address, region_of(box), folder_ / "b.gpkg");
        EXPECT_EQ(of_file.digest, of_server.digest);
        EXPECT_GT(of_file.passes, 0U);
        EXPECT_THAT(different_rows(folder_ / "a.gpkg", folder_ / "b.gpkg"), IsEmpty());
        EXPECT_EQ(read_key(of_file.key_file)->hex(), read_key(of_server.key_file)->hex());
    }

    fs::path folder_ = test_folder();
    PostgresServer server_;
    EngineDatabase database_{Engine::geopackage, folder_, cut_roads().roads, settings()};
};

TEST_F(CutsOfBothEngines, HaveTheSameRows) {
    expect_same_cuts(box_around(cut_roads().places.at('C')));
}

TEST_F(CutsOfBothEngines, HaveAllRowsOfEveryTableInARegionOfAllRoads) {
    fill_all_tables(database_.name());
    std::set<std::string> tables;
    for (const auto& [name, object] : own_schema()) {
        const auto& table = name.second;
        if (name.first == "table" && !table.starts_with("gpkg_") && !table.starts_with("rtree_") &&
            !table.starts_with("sqlite_") && table != "layer_styles" && table != "import_note") {
            tables.insert(table);
        }
    }
    tables.erase("strip_dirty"); // which rows_of_tables() leaves out
    EXPECT_EQ(tables_in(rows_of_tables(database_.name())), tables);
    cut_from(database_.name(), region_of({4, 45, 5, 46}), folder_ / "all.gpkg");
    auto different = different_rows(database_.name(), folder_ / "all.gpkg");
    std::erase_if(different,
                  [](const std::string& row) { // not promised, and a sum in another order
                      return row == "meta|rows_in_order|0" || row.starts_with("meta|network_m|");
                  });
    EXPECT_THAT(different, IsEmpty());
    EXPECT_EQ(Database(folder_ / "all.gpkg", Database::Access::read)
                  .number("SELECT count(*) FROM strip_dirty"),
              1);
    expect_same_cuts({4, 45, 5, 46});
}

TEST_F(CutsOfBothEngines, NeedTheRightsOfCopyOnAServer) {
    const auto address = server_.new_database("roads");
    copy_to_server(database_.name(), address, {}, {});
    ServerConnection boss{server_.address("roads")};
    boss.run("CREATE ROLE guest LOGIN; GRANT USAGE ON SCHEMA macadam TO guest;"
             " GRANT SELECT ON macadam.meta, macadam.migration, macadam.way, macadam.segment,"
             " macadam.segment_state TO guest");
    EXPECT_THAT(refusal_of([&] {
                    cut_from(server_.address("roads", "guest"),
                             region_of(box_around(cut_roads().places.at('C'))),
                             folder_ / "other.gpkg");
                }),
                HasSubstr("permission denied"));
    EXPECT_FALSE(fs::exists(folder_ / "other.gpkg"));
}

} // namespace
} // namespace macadam::testing
