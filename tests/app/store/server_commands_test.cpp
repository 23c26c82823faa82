// Commands that write to a database on a PostgreSQL server, as users run them.

#include "storage/postgres/server_connection.hpp"
#include "support/http/http_client.hpp"
#include "support/program/piped_program.hpp"
#include "support/program/places.hpp"
#include "support/program/postgres_server.hpp"
#include "support/program/program.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

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
    std::string trip_ = source_folder() + "/sample_data/gyor/gyor_q3_00.trip.csv";
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

TEST_F(ServerCommands, WarnASuperuserWhoImports) {
    const auto boss = server_.address("roads");
    const std::string words = "warning: connected as a superuser of the server: a role that was "
                              "granted macadam_importer is enough";
    ASSERT_EQ(run_on(address_, {"init", "--trace", trip_}).exit_status, 0);
    EXPECT_THAT(run_on(boss, {"import", trip_, "--method", "kf"}).err, HasSubstr(words));
    EXPECT_THAT(run_on(address_, {"import", trip_, "--method", "kf"}).err,
                Not(HasSubstr("superuser")));

    const auto folder = std::filesystem::path{file_}.parent_path();
    const auto incoming = folder / "incoming";
    std::filesystem::create_directories(incoming);
    write_file(incoming / "a.trip.csv.gz", "no log");
    std::filesystem::last_write_time(incoming / "a.trip.csv.gz",
                                     std::filesystem::file_time_type::clock::now() -
                                         std::chrono::hours{1});
    PipedProgram watch{{"watch", boss, incoming.string(), "--json"}};
    EXPECT_THAT(watch.line(std::chrono::seconds{60}).value_or(""), HasSubstr("\"rejected\""));
    watch.signal(SIGTERM);
    EXPECT_THAT(watch.wait().err, HasSubstr(words));

    const auto objects = (folder / "objects").string();
    ASSERT_EQ(run_on(address_, {"submit", trip_, "--objects", objects}).exit_status, 0);
    EXPECT_THAT(run_on(boss, {"worker", "--once", "--method", "kf"}).err, HasSubstr(words));
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
    ServerConnection server{address_}; // with what a killed importer left
    server.run("INSERT INTO macadam.unfinished VALUES (1000, now() - interval '1 hour')");
    EXPECT_EQ(run_on(address_, {"worker", "--once"}).exit_status, 0);
    EXPECT_EQ(server.number("SELECT count(*) FROM macadam.unfinished"), 0);
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

TEST_F(ServerCommands, ReadWhatTheyReadOfAFile) {
    run_on_both({"init", "--trace", trip_});
    run_on_both({"import", trip_, "--method", "kf"});
    for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
             {"query", "--worst", "3", "--segments", "--format", "csv"},
             {"query", "--worst", "3", "--format", "csv", "--min-length", "20"},
             {"query", "--near", "47.6863,17.6799", "--radius", "300", "--format", "csv"},
             {"query", "--segment", "1+0003", "--passes", "--format", "csv"},
             {"query", "--way", "1", "--history", "--format", "csv"},
             {"query", "--class", "poor", "--since", "2020-01", "--format", "csv"},
             {"export", "-o", "-", "--format", "csv"},
             {"export", "-o", "-", "--format", "geojson", "--min-passes", "1"},
             {"render", "-o", "-", "--size", "400x300"},
             {"render", "-o", "-", "--size", "400x300", "--bbox", "17.67,47.68,17.69,47.69"}}) {
        const auto on_server = run_on(address_, words), in_file = run_on(file_, words);
        EXPECT_EQ(on_server.exit_status, 0) << on_server.err;
        EXPECT_FALSE(in_file.out.empty()) << words.at(1);
        EXPECT_EQ(on_server.out, in_file.out) << words.at(1);
    }
    const auto folder = fresh_folder();
    const auto report = (folder / "report.html").string();
    EXPECT_EQ(run_on(address_, {"report", "-o", report}).exit_status, 0);
    EXPECT_GT(std::filesystem::file_size(report), 10'000U);
    const auto tiles = (folder / "tiles.pmtiles").string();
    EXPECT_EQ(run_on(address_, {"export", "-o", tiles, "--tiles", "picture", "--zoom", "12-13"})
                  .exit_status,
              0);
    EXPECT_GT(std::filesystem::file_size(tiles), 1'000U);
}

TEST_F(ServerCommands, ServeADatabaseWhileItGrows) {
    ASSERT_EQ(run_on(address_, {"init", "--trace", trip_}).exit_status, 0);
    const auto port = quiet_port();
    PipedProgram serve{{"serve", address_, "--listen", "127.0.0.1:" + std::to_string(port)}};
    const auto await = [&](const std::string& words) { // the test's time limit ends it
        while (get(port, "/collections/segments/items?limit=1").body.find(words) ==
               std::string::npos) {
            std::this_thread::sleep_for(std::chrono::milliseconds{100});
        }
    };
    await("\"numberMatched\":0,");
    ASSERT_EQ(run_on(address_, {"import", trip_, "--method", "kf"}).exit_status, 0);
    await("\"iri\":");
    serve.signal(SIGTERM);
    EXPECT_EQ(serve.wait().exit_status, 0);
    const auto refused = run_on(address_, {"serve", "--workers", "2"});
    EXPECT_EQ(refused.exit_status, 2);
    EXPECT_THAT(refused.err, HasSubstr("--workers is for a .gpkg file"));
}

TEST_F(ServerCommands, SayWhyTheyCannot) {
    EXPECT_THAT(run_on(address_, {"import", trip_}).err, HasSubstr("has no road database"));
    const auto crowd = run_on(address_,
                              {"init",
                               "--network",
                               "a.osm",
                               "--privacy",
                               "crowd",
                               "--keep-logs",
                               "30",
                               "--logs-key",
                               "logs.key"});
    EXPECT_EQ(crowd.exit_status, 2);
    EXPECT_THAT(crowd.err,
                HasSubstr("--keep-logs is for a .gpkg file: workers of a database on a"));
    ASSERT_EQ(run_on(address_, {"init", "--trace", trip_}).exit_status, 0);
    const auto twice = run_on(address_, {"init", "--trace", trip_});
    EXPECT_EQ(twice.exit_status, 1);
    EXPECT_THAT(twice.err, HasSubstr("already has a schema macadam"));
    EXPECT_THAT(run_on(address_, {"forget", "--trip", "none"}).err,
                AllOf(HasSubstr(address_ + ": has no trip 'none'"), HasSubstr("SHA-256")));
    EXPECT_THAT(run_on(address_, {"privacy", "crowd"}).err,
                HasSubstr("its roads were traced from trips"));
    EXPECT_THAT(run_on(address_, {"publish"}).err, HasSubstr("expected a crowd database"));
}

} // namespace
} // namespace macadam::testing
