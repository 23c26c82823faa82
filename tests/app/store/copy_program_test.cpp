// `macadam copy` and the commands that read a database on a server, as users run them.

#include "storage/store/road_store.hpp"
#include "support/program/postgres_server.hpp"
#include "support/program/program.hpp"
#include "support/roads/store_world.hpp"

#include <gmock/gmock.h>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class CopyProgram : public ::testing::Test {
protected:
    void SetUp() override {
        folder_ = fresh_folder();
        file_ = (folder_ / "roads.gpkg").string();
        auto store = new_store(file_);
        import_trips(store, 3);
    }

    PostgresServer server_;
    std::string address_ = server_.new_database("roads");
    fs::path folder_;
    std::string file_;
};

TEST_F(CopyProgram, CopiesThereAndBackAndSaysTheDigest) {
    const auto digest = run_macadam({"info", file_, "--digest"}).out;
    const auto there = run_macadam({"copy", file_, address_});
    EXPECT_EQ(there.exit_status, 0) << there.err;
    EXPECT_THAT(there.out, HasSubstr("3 trips, 60 passes; digest on both sides: " + digest));
    EXPECT_THAT(there.err, HasSubstr(".key: key of the cars, not on the server; keep it"));
    const auto back = run_macadam({"copy", address_, (folder_ / "back.gpkg").string(), "--json"});
    EXPECT_EQ(back.exit_status, 0) << back.err;
    EXPECT_THAT(back.out, HasSubstr(digest.substr(0, 64)));
    EXPECT_EQ(run_macadam({"info", (folder_ / "back.gpkg").string(), "--digest"}).out, digest);
    const auto to_file = run_macadam({"copy", file_, (folder_ / "c.gpkg").string()});
    EXPECT_EQ(to_file.exit_status, 2);
    EXPECT_THAT(to_file.err, HasSubstr("or --bbox or --area, which cut a region out"));
    EXPECT_EQ(run_macadam({"copy", address_, address_}).exit_status, 2);
    EXPECT_EQ(run_macadam({"copy", file_, address_}).exit_status, 1); // one is there already
}

TEST_F(CopyProgram, CutsARegionOutIntoAFile) {
    ASSERT_EQ(run_macadam({"copy", file_, address_}).exit_status, 0);
    const auto all = run_macadam({"info", file_, "--digest"}).out;
    const auto town = (folder_ / "town.gpkg").string();
    const auto cut = run_macadam({"copy", address_, town, "--bbox", "4,45,5,46", "--json"});
    EXPECT_EQ(cut.exit_status, 0) << cut.err;
    EXPECT_THAT(cut.out, HasSubstr("\"trips\":3,\"passes\":60,\"digest\":\"" + all.substr(0, 64)));
    EXPECT_THAT(run_macadam({"info", town, "--audit"}).out,
                HasSubstr("cut: the box 4,45,5,46 of " + address_));
    EXPECT_EQ(run_macadam({"query", town, "--worst", "3", "--json"}).out,
              run_macadam({"query", file_, "--worst", "3", "--json"}).out);
    write_file(folder_ / "town.geojson",
               R"({"type":"Feature","properties":{},"geometry":{"type":"Polygon",)"
               R"("coordinates":[[[4,45],[5,45],[5,46],[4,45]]]}})");
    const auto area = run_macadam({"copy",
                                   address_,
                                   (folder_ / "area.gpkg").string(),
                                   "--area",
                                   (folder_ / "town.geojson").string()});
    EXPECT_EQ(area.exit_status, 0) << area.err;
    EXPECT_THAT(area.out, HasSubstr("3 trips, 60 passes; digest on both sides: " + all));

    const auto again = run_macadam({"copy", address_, town, "--bbox", "4,45,5,46"});
    EXPECT_EQ(again.exit_status, 1);
    EXPECT_THAT(again.err, HasSubstr("town.gpkg: already exists"));
    const auto other = (folder_ / "other.gpkg").string();
    EXPECT_THAT(run_macadam({"copy", address_, other, "--bbox", "10,50,11,51"}).err,
                HasSubstr("no road lies in the box 10,50,11,51; its roads lie in the box 4.8"));
    const auto empty = run_macadam({"copy", address_, other, "--bbox", "4,45,4,46"});
    EXPECT_EQ(empty.exit_status, 2);
    EXPECT_THAT(empty.err, HasSubstr("--bbox is 4,45,4,46, expected west,south,east,north"));
    for (const auto& from : {file_, address_}) {
        const auto to_server = run_macadam({"copy", from, address_, "--bbox", "4,45,5,46"});
        EXPECT_EQ(to_server.exit_status, 2);
        EXPECT_THAT(to_server.err, HasSubstr("expected TO to be a new .gpkg file"));
    }
}

TEST_F(CopyProgram, CutsARegionOutOfAFile) {
    const auto all = run_macadam({"info", file_, "--digest"}).out;
    const auto town = (folder_ / "town.gpkg").string();
    const auto cut = run_macadam({"copy", file_, town, "--bbox", "4,45,5,46"});
    EXPECT_EQ(cut.exit_status, 0) << cut.err;
    EXPECT_THAT(cut.out, HasSubstr("3 trips, 60 passes; digest on both sides: " + all));
    EXPECT_THAT(cut.err, HasSubstr("town.gpkg.key: key of the cars; keep it"));
    EXPECT_EQ(run_macadam({"info", town, "--digest"}).out, all);
    EXPECT_THAT(run_macadam({"info", town, "--audit"}).out,
                HasSubstr("cut: the box 4,45,5,46 of " + file_));
    const auto other = (folder_ / "other.gpkg").string();
    const auto empty = run_macadam({"copy", file_, other, "--bbox", "10,50,11,51"});
    EXPECT_EQ(empty.exit_status, 1);
    EXPECT_THAT(empty.err,
                HasSubstr("no road lies in the box 10,50,11,51; its roads lie in the box 4.8"));
    EXPECT_FALSE(fs::exists(other));
}

TEST_F(CopyProgram, LetsTheServersDatabaseBeReadLikeTheFile) {
    ASSERT_EQ(run_macadam({"copy", file_, address_}).exit_status, 0);
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"info", "--digest"},
          {"info", "--table", "classes"},
          {"query", "--worst", "3", "--json"},
          {"query", "--road", "rue", "--json"},
          {"query", "--segment", "1+0003", "--json"},
          {"query", "--way", "1", "--since", "2025-12", "--json"}}) {
        const auto run_on = [&](const std::string& store) {
            auto all = words;
            all.insert(all.begin() + 1, store);
            return run_macadam(all);
        };
        const auto on_file = run_on(file_), on_server = run_on(address_);
        EXPECT_EQ(on_server.exit_status, 0) << words[1] << on_server.err;
        EXPECT_EQ(on_server.out, on_file.out) << words[1];
    }
    for (const std::string name : {"a.geojson", "a.csv"}) {
        const auto run = run_macadam({"export", address_, "-o", (folder_ / name).string()});
        EXPECT_EQ(run.exit_status, 0) << run.err;
        EXPECT_EQ(
            run_macadam({"export", file_, "-o", (folder_ / ("f" + name)).string()}).exit_status, 0);
        EXPECT_EQ(read_file(folder_ / name), read_file(folder_ / ("f" + name)));
    }
    EXPECT_THAT(run_macadam({"export", address_, "-o", (folder_ / "a.qgz").string()}).err,
                HasSubstr("works on a GeoPackage file only so far"));
}

} // namespace
} // namespace macadam::testing
