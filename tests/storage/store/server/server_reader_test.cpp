// What commands that read fetch from a PostgreSQL server: parts, and copies that are kept.

#include "storage/store/server/reader/server_reader.hpp"

#include "storage/postgres/server_connection.hpp"
#include "storage/store/fusion/store_version.hpp"
#include "storage/store/server/copy/new_copy.hpp"
#include "storage/store/server/copy/store_copy.hpp"
#include "storage/store/server/reader/chunk_choice.hpp"
#include "storage/store/server/reader/local_copy.hpp"
#include "storage/store/server/reader/server_mirror.hpp"
#include "storage/store/server/user_files.hpp"
#include "support/files/files.hpp"
#include "support/roads/engine_world.hpp"
#include "support/roads/store_world.hpp"

#include <gmock/gmock.h>

#include <cstddef>
#include <filesystem>
#include <future>
#include <optional>
#include <string>
#include <vector>

namespace macadam::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

namespace fs = std::filesystem;

class ServerReaders : public ::testing::Test {
protected:
    fs::path refreshed(ServerContent content = ServerContent::all) {
        ServerConnection server{database_.name()};
        return refreshed_mirror(server, content, {}, {});
    }
    StoreReader read(const ServerNeed& need = {}) {
        return StoreReader{open_server_reader(database_.name(), need, Audience::operator_, {}, {})};
    }
    /// What a reader without any kept copy sees.
    std::string digest_now() {
        ServerConnection server{database_.name()};
        return StoreReader{open_server_copy(server,
                                            Database::Access::read,
                                            {},
                                            {},
                                            [](RowsFromServer& rows, Database& file) {
                                                fill_copy(rows, file, ServerContent::all);
                                            })}
            .digest();
    }
    static std::size_t number_of_copies() {
        std::size_t count = 0;
        for (const auto& entry : fs::directory_iterator{mirror_folder()}) {
            count += entry.path().extension() == ".gpkg" ? 1 : 0;
        }
        return count;
    }
    std::string moment_of_copy() {
        Database file{refreshed(), Database::Access::read};
        auto select = file.prepare("SELECT value FROM meta WHERE key = ?");
        return select.bind(mirror_moment_key).step() ? select.text(0) : "";
    }

    fs::path folder_ = test_folder();
    EngineDatabase database_{Engine::postgresql, folder_};
};

TEST_F(ServerReaders, KeepACopyThatFollowsTripsAndFusion) {
    const auto import = database_.import();
    const auto empty = refreshed();
    for (int number = 0; number < 4; ++number) {
        add_rich_trip(*import.trips, number);
        EXPECT_EQ(read().info().trips, static_cast<std::size_t>(number + 1));
        EXPECT_EQ(read().waiting(), 20U);
        EXPECT_EQ(read().digest(), digest_now());
        fuse_all(*import.trips);
        const auto reader = read();
        EXPECT_EQ(reader.digest(), digest_now());
        EXPECT_EQ(reader.waiting(), 0U);
        EXPECT_EQ(reader.info().vehicles.size(), database_.read().info().vehicles.size());
        EXPECT_THAT(reader.changes({1, true, 3}), SizeIs(number + 1));
        EXPECT_THAT(reader.audit(), SizeIs(number + 1));
        EXPECT_THAT(reader.history({1, true, 3}), SizeIs(number + 1));
    }
    EXPECT_EQ(refreshed(), empty); // one file all the time
    EXPECT_EQ(number_of_copies(), 1U);
}

TEST_F(ServerReaders, LeaveACopyAloneWhileNothingChanges) {
    import_rich_trips(*database_.import().trips, 2);
    const auto moment = moment_of_copy();
    EXPECT_FALSE(moment.empty());
    ServerConnection{database_.name()}.run(
        "CREATE TABLE public.other (i int); DROP TABLE public.other");
    EXPECT_EQ(moment_of_copy(), moment);
    add_rich_trip(*database_.import().trips, 2);
    EXPECT_NE(moment_of_copy(), moment);
}

TEST_F(ServerReaders, LeaveACopyOfRowsAloneThatPgDumpBroughtFromABusierServer) {
    import_rich_trips(*database_.import().trips, 2);
    ServerConnection{database_.name()}.run(
        "UPDATE macadam.trip SET changed = '1000000000000';"
        "UPDATE macadam.chunk_change SET changed = '1000000000000'");
    const auto moment = moment_of_copy();
    ServerConnection{database_.name()}.run(
        "CREATE TABLE public.other (i int); DROP TABLE public.other"); // one transaction later
    EXPECT_EQ(moment_of_copy(), moment);
    add_rich_trip(*database_.import().trips, 2);
    EXPECT_EQ(read().info().trips, 3U);
}

TEST_F(ServerReaders, KeepTheCopyFromOtherUsers) {
    const auto file = refreshed();
    EXPECT_EQ(fs::status(file).permissions(), fs::perms::owner_read | fs::perms::owner_write);
    EXPECT_EQ(fs::status(mirror_folder()).permissions(), fs::perms::owner_all);
}

TEST_F(ServerReaders, MakeTheCopyAnewAfterForgettingAndKeepNoOther) {
    import_rich_trips(*database_.import().trips, 3);
    const auto before = refreshed();
    database_.forget({.trips = {trip_record(1).sha256}, .vehicles = {}});
    EXPECT_FALSE(fs::exists(before)); // as the trip is to be gone at once
    EXPECT_FALSE(fs::exists(before.string() + "-wal"));
    EXPECT_EQ(read().info().trips, 2U);
    EXPECT_EQ(read().digest(), digest_now());
    EXPECT_NE(refreshed(), before);
    EXPECT_EQ(number_of_copies(), 1U);
}

TEST_F(ServerReaders, KeepACopyForEachAddressAsACloneOfAServerHasItsNumbers) {
    import_rich_trips(*database_.import().trips, 2);
    ServerConnection other{database_.name() + "&application_name=other"};
    const auto copy = refreshed_mirror(other, ServerContent::all, {}, {});
    const auto usual = refreshed();
    EXPECT_NE(usual, copy);
    EXPECT_EQ(refreshed_mirror(other, ServerContent::all, {}, {}), copy);
    EXPECT_EQ(number_of_copies(), 2U);
    database_.forget({.trips = {trip_record(1).sha256}, .vehicles = {}});
    EXPECT_EQ(number_of_copies(), 0U);
}

TEST_F(ServerReaders, FollowATransactionThatCommitsAfterALaterOne) {
    const auto late = database_.import(), early = database_.import();
    ServerConnection holder{database_.name()};
    holder.run("BEGIN");
    holder.run("INSERT INTO macadam.trip (sha256, trip_id, file_name, vehicle_model, method,"
               " distance_mm, matched_mm, rows_read, rows_used) VALUES (repeat('e', 64), 'late',"
               " '', '', 'kf', 1, 0, 1, 0)");
    add_rich_trip(*early.trips, 1);
    EXPECT_EQ(read().info().trips, 1U);
    const auto before = read().moment();
    EXPECT_TRUE(read().changed_since(before));
    holder.run("COMMIT"); // its number is lower than that of the trip that was copied
    EXPECT_FALSE(read().changed_since(before)); // what is above that number would not be all
    EXPECT_EQ(read().info().trips, 2U);
}

TEST_F(ServerReaders, TakeTurnsAtOneCopy) {
    const auto import = database_.import();
    for (int number = 0; number < 4; ++number) {
        add_rich_trip(*import.trips, number);
        std::vector<std::future<std::size_t>> readers;
        for (int i = 0; i < 3; ++i) {
            readers.push_back(std::async(std::launch::async, [&] { return read().info().trips; }));
        }
        for (auto& reader : readers) {
            EXPECT_EQ(reader.get(), static_cast<std::size_t>(number + 1));
        }
        fuse_all(*import.trips);
    }
    EXPECT_EQ(read().digest(), digest_now());
}

TEST_F(ServerReaders, ReadRoadsAndValuesWithTheRightsOfAReader) {
    import_rich_trips(*database_.import().trips, 3);
    ServerConnection boss{database_.server().address("roads")};
    boss.run("DO $$ BEGIN IF NOT EXISTS (SELECT FROM pg_roles WHERE rolname = 'macadam_reader')"
             " THEN CREATE ROLE macadam_reader NOLOGIN; END IF; END $$;"
             "GRANT USAGE ON SCHEMA macadam TO macadam_reader;"
             "GRANT SELECT ON macadam.migration, macadam.meta, macadam.way, macadam.segment,"
             " macadam.segment_state, macadam.chunk_state, macadam.background, macadam.place,"
             " macadam.road_ref, macadam.chunk_change, macadam.chunk_dirty TO macadam_reader;"
             "CREATE ROLE visitor LOGIN IN ROLE macadam_reader");
    const auto address = database_.server().address("roads", "visitor");
    ServerNeed values;
    values.content.passes = false;
    const auto open = [&](const ServerNeed& need) {
        return StoreReader{open_server_reader(address, need, Audience::anyone, {}, {})};
    };
    const auto states = [](const StoreReader& store) {
        std::vector<std::optional<SegmentState>> found;
        store.visit({}, [&](const SegmentRecord& record) { found.push_back(record.state); });
        return found;
    };
    EXPECT_THAT(states(open(values)), Not(IsEmpty()));
    EXPECT_EQ(states(open(values)), states(read()));
    add_rich_trip(*database_.import().trips, 3);
    fuse_all(*database_.import().trips);
    EXPECT_EQ(states(open(values)), states(read())); // a copy without trips follows, too
    EXPECT_THAT(refusal_of([&] { open({}); }), HasSubstr("permission denied"));
}

TEST_F(ServerReaders, FetchPartsThatAnswerLikeTheWhole) {
    import_rich_trips(*database_.import().trips, 6);
    const auto whole = read();
    SegmentFilter box, way, road, key, worst, often, period, nothing;
    box.box = whole.map_box();
    box.box->east_deg = (box.box->west_deg + box.box->east_deg) / 2;
    way.way_id = 1;
    road.name_part = "ÉPÉE 100%";
    key.key = SegmentKey{1, false, 3};
    worst.worst = 3;
    often.min_passes = 4;
    period.way_id = 1;
    period.period = Period{.from_ms = 1'765'000'000'000, .until_ms = {}};
    nothing.way_id = 4711;
    ServerConnection server{database_.name()};
    for (const auto& filter : {box, way, road, key, worst, often, period, nothing}) {
        ASSERT_TRUE(chooses_chunks(filter));
        ServerTransaction one_moment{server, true};
        const auto chunks = chunks_for(server, filter);
        const StoreReader part{open_server_part(
            server, chunks, {.passes = true, .background = false}, Audience::operator_, {}, {})};
        std::vector<std::pair<SegmentKey, std::optional<SegmentState>>> expected, found;
        whole.visit(filter, [&](const SegmentRecord& record) {
            expected.emplace_back(record.segment.key, record.state);
        });
        part.visit(filter, [&](const SegmentRecord& record) {
            found.emplace_back(record.segment.key, record.state);
        });
        EXPECT_EQ(found, expected);
        EXPECT_EQ(found.empty(), filter.way_id == 4711) << chunks.size();
        EXPECT_EQ(part.seen().first_ms, whole.seen().first_ms);
        EXPECT_EQ(part.events(filter).size(), whole.events(filter).size());
    }
}

TEST_F(ServerReaders, FetchOnlyTheChunksInQuestion) {
    import_rich_trips(*database_.import().trips, 2);
    ServerConnection server{database_.name()};
    SegmentFilter one, everything, unnamed;
    one.key = SegmentKey{2, true, 0};
    one.with_state_only = false;
    EXPECT_THAT(chunks_for(server, one), SizeIs(1));
    unnamed.name_part = "no such road";
    EXPECT_THAT(chunks_for(server, unnamed), IsEmpty());
    EXPECT_FALSE(chooses_chunks(everything));
    everything.worst = 1; // found on the server, by its value
    EXPECT_THAT(chunks_for(server, everything), SizeIs(1));
    ServerTransaction one_moment{server, true};
    const StoreReader part{
        open_server_part(server, chunks_for(server, one), {}, Audience::operator_, {}, {})};
    std::vector<std::int64_t> ways;
    SegmentFilter with_all;
    with_all.with_state_only = false;
    part.visit(with_all,
               [&](const SegmentRecord& record) { ways.push_back(record.segment.key.way_id); });
    EXPECT_THAT(ways, ::testing::AllOf(Not(IsEmpty()), ::testing::Each(2)));
}

TEST_F(ServerReaders, LeadANameToTheCopy) {
    import_rich_trips(*database_.import().trips, 2);
    LocalCopy copy{database_.name(), {}, {}};
    EXPECT_EQ(copy.file().filename(), "roads.gpkg");
    EXPECT_EQ(StoreReader::open(copy.file()).info().trips, 2U);
    database_.forget({.trips = {trip_record(1).sha256}, .vehicles = {}});
    copy.refresh({}); // the name leads to another file now
    EXPECT_EQ(StoreReader::open(copy.file()).info().trips, 1U);
    const LocalCopy file{folder_ / "roads.gpkg", {}, {}};
    EXPECT_EQ(file.file(), folder_ / "roads.gpkg");
}

// Of a country the planner, which knows little of a table that grows, read every segment.
TEST_F(ServerReaders, OfAFewChunksReadTheirRowsAloneWhateverThePlannerExpects) {
    import_rich_trips(*database_.import().trips, 2);
    std::vector<ServerChunk> chunks;
    std::int64_t all_states = 0;
    {
        ServerConnection reader{database_.name()};
        chunks = chunks_for(reader, {});
        all_states = reader.number("SELECT count(*) FROM macadam.segment_state");
        reader.run("ALTER DATABASE roads SET enable_nestloop = off");
        reader.run("ALTER DATABASE roads SET enable_seqscan = off"); // tables are small here
    }
    ASSERT_GT(chunks.size(), 1U);
    chunks.resize(1);
    const std::string states = "^segment_state_[0-9]+$";
    const auto before = database_.rows_read_by_index_of(states);
    std::int64_t segments = 0;
    {
        ServerConnection reader{database_.name()};
        ServerTransaction one_moment{reader, true};
        const StoreReader part{
            open_server_part(reader, chunks, {.passes = false}, Audience::operator_, {}, {})};
        part.visit({}, [&](const SegmentRecord&) { ++segments; });
    }
    ASSERT_GT(segments, 0);
    ASSERT_LT(segments, all_states);
    constexpr int ends_of_period = 2; // each a row of an index
    EXPECT_EQ(database_.rows_read_by_index_of(states) - before, segments + ends_of_period);
}

TEST_F(ServerReaders, FindPlacesByIndexes) {
    const std::string tables = "^(segment|drive|segment_state)_\\d+$|^(trip|vehicle|way|event"
                               "|event_search|chunk_state|calibration|calibration_period)$";
    {
        const auto import = database_.import();
        for (int number = 0; number < 4; ++number) {
            add_rich_trip(*import.trips, number);
        }
        fuse_all(*import.trips);
        // Tables are small here.
        ServerConnection{database_.name()}.run("ALTER DATABASE roads SET enable_seqscan = off");
    }
    const auto before = database_.scans_of(tables);
    ASSERT_GE(before.size(), 11U);
    SegmentFilter box, way, one;
    box.box = GeoBox{-180, -90, 180, 90};
    way.way_id = 1;
    one.key = SegmentKey{1, true, 0};
    for (const auto& filter : {box, way, one}) {
        ServerConnection reader{database_.name()};
        ServerTransaction one_moment{reader, true};
        const auto chunks = chunks_for(reader, filter);
        EXPECT_THAT(chunks, Not(IsEmpty()));
        for (const bool passes : {false, true}) {
            const StoreReader part{
                open_server_part(reader, chunks, {.passes = passes}, Audience::operator_, {}, {})};
            EXPECT_TRUE(part.seen().last_ms);
        }
    }
    EXPECT_EQ(database_.scans_of(tables), before);
}

} // namespace
} // namespace macadam::testing
