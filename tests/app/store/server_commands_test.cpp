// Commands that write to a database on a PostgreSQL server, as users run them.

#include "support/program/postgres_server.hpp"
#include "support/program/program.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace macadam::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class ServerCommands : public ::testing::Test {
protected:
    macadam::testing::Run run_on(const std::string& store, std::vector<std::string> words) {
        words.insert(words.begin() + 1, store);
        return run_macadam(words);
    }

    /// Runs a command on the server and on a file.
    void run_on_both(const std::vector<std::string>& words) {
        for (const auto& store : {address_, file_}) {
            const auto run = run_on(store, words);
            EXPECT_EQ(run.exit_status, 0) << words.front() << ": " << run.err;
        }
    }

    void expect_one_digest(const std::string& after) {
        const auto on_server = run_on(address_, {"info", "--digest"});
        EXPECT_EQ(on_server.exit_status, 0) << on_server.err;
        EXPECT_EQ(on_server.out, run_on(file_, {"info", "--digest"}).out) << after;
    }

    PostgresServer server_;
    std::string address_ = server_.new_database("roads");
    std::string file_ = (fresh_folder() / "roads.gpkg").string();
    std::string trip_ = MACADAM_SOURCE_DIR "/sample_data/gyor/gyor_q3_00.trip.csv";
};

TEST_F(ServerCommands, WriteWhatTheyWriteToAFile) {
    run_on_both({"init", "--trace", trip_});
    run_on_both({"import", trip_, "--method", "kf"});
    expect_one_digest("import");
    const auto again = run_on(address_, {"import", trip_, "--method", "kf"});
    EXPECT_THAT(again.err, HasSubstr("0 trips imported, 1 already imported"));
    run_on_both({"valid-from", "--since", "2026-01-01", "--way", "1"});
    expect_one_digest("valid-from");
    run_on_both({"reprocess", trip_, "--method", "kf", "--rate", "50"});
    expect_one_digest("reprocess");
    run_on_both({"forget", "--trip", "gyor_q3_00.trip.csv"});
    expect_one_digest("forget");
    EXPECT_THAT(run_on(address_, {"import", trip_}).err,
                HasSubstr("0 trips imported, 1 already imported"));
}

TEST_F(ServerCommands, WriteToCellsOnAnotherServerWhatTheyWriteToAFile) {
    run_on_both({"init", "--trace", trip_});
    const auto list = run_on(address_, {"cells", "--json"});
    const auto cells = nlohmann::json::parse(list.out);
    ASSERT_EQ(cells.size(), 1U) << list.err;
    EXPECT_TRUE(cells[0]["server"].is_null());
    const auto number = std::to_string(cells[0]["cell"].get<int>());
    const auto east = server_.new_database("east");
    const auto moved = run_on(server_.address("roads"), {"cells", "--move", number, "--to", east});
    EXPECT_EQ(moved.exit_status, 0);
    EXPECT_THAT(moved.err, HasSubstr("cell " + number + ": 0 rows moved to " + east));
    EXPECT_THAT(moved.out, HasSubstr("dbname='east'"));
    run_on_both({"import", trip_, "--method", "kf"});
    expect_one_digest("import");
    run_on_both({"reprocess", trip_, "--method", "kf", "--rate", "50"});
    expect_one_digest("reprocess");
    run_on_both({"forget", "--trip", "gyor_q3_00.trip.csv"});
    expect_one_digest("forget");
}

TEST_F(ServerCommands, SayWhyTheyCannotMoveCells) {
    ASSERT_EQ(run_on(address_, {"init", "--trace", trip_}).exit_status, 0);
    EXPECT_THAT(run_on(address_, {"cells", "--move", "1"}).err,
                HasSubstr("--move is without --to, expected both: where the cells go"));
    EXPECT_THAT(run_on(address_, {"cells", "--to", address_}).err,
                HasSubstr("--to is without --move, expected both: which cells go there"));
    EXPECT_THAT(run_on(address_, {"cells", "--move", "x", "--to", address_}).err,
                HasSubstr("--move has 'x', expected numbers of cells"));
    EXPECT_THAT(run_on(address_, {"cells", "--move", "1", "--to", "east"}).err,
                HasSubstr("--to is 'east', expected postgresql://USER@HOST/DATABASE"));
    const auto none = run_on(address_, {"cells", "--move", "1", "--to", address_});
    EXPECT_EQ(none.exit_status, 1);
    EXPECT_THAT(none.err, HasSubstr("has no cell 1; 'macadam cells " + address_ + "' lists them"));
}

TEST_F(ServerCommands, SayWhyTheyCannot) {
    EXPECT_THAT(run_on(address_, {"import", trip_}).err, HasSubstr("has no road database"));
    const auto crowd = run_on(address_, {"init", "--network", "a.osm", "--privacy", "crowd"});
    EXPECT_EQ(crowd.exit_status, 2);
    EXPECT_THAT(crowd.err, HasSubstr("--privacy crowd works with a .gpkg file only so far"));
    ASSERT_EQ(run_on(address_, {"init", "--trace", trip_}).exit_status, 0);
    const auto twice = run_on(address_, {"init", "--trace", trip_});
    EXPECT_EQ(twice.exit_status, 1);
    EXPECT_THAT(twice.err, HasSubstr("already has a schema macadam"));
    EXPECT_THAT(run_on(address_, {"forget", "--trip", "none"}).err,
                AllOf(HasSubstr(address_ + ": has no trip 'none'"), HasSubstr("SHA-256")));
    EXPECT_THAT(run_on(address_, {"privacy", "crowd"}).err,
                HasSubstr("works on a GeoPackage file only so far"));
}

} // namespace
} // namespace macadam::testing
