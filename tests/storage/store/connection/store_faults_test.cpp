#include "storage/geopackage/geopackage_geometry.hpp"
#include "storage/store/road_store.hpp"

#include "storage/atomic/atomic_file.hpp"
#include "storage/exports/export.hpp"
#include "storage/geopackage/geopackage.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "support/files/files.hpp"
#include "support/program/fork.hpp"
#include "support/roads/store_world.hpp"

#include <gmock/gmock.h>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <optional>

namespace macadam {
namespace {

using testing::add_trip;
using testing::fork_without_threads;
using ::testing::HasSubstr;
using testing::import_trips;
using testing::new_store;
using testing::passes_of;
using testing::refusal_of;
using testing::test_folder;
using testing::trip_record;

/// While it lives, no file of this program can grow past `bytes`: as on a full disk.
class FullDisk {
public:
    explicit FullDisk(rlim_t bytes) : handler_{std::signal(SIGXFSZ, SIG_IGN)} {
        ::getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit small{bytes, before_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &small);
    }
    FullDisk(const FullDisk&) = delete;
    FullDisk& operator=(const FullDisk&) = delete;
    ~FullDisk() {
        ::setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, handler_);
    }

private:
    rlimit before_{};
    void (*handler_)(int);
};

/// Many passes of one trip: more than fits between two pages.
std::vector<Pass> long_trip() {
    std::vector<Pass> passes;
    for (std::uint32_t round = 0; round < 200; ++round) {
        for (auto pass : passes_of(9)) {
            pass.occurrence = round;
            passes.push_back(pass);
        }
    }
    return passes;
}

TEST(StoreFaults, OfAFullDiskLeaveTheStoreAsItWas) {
    const auto file = test_folder() / "a.gpkg";
    auto store = new_store(file);
    import_trips(store, 2);
    const auto before = store.digest();
    {
        const FullDisk full{std::filesystem::file_size(file)};
        EXPECT_THAT(refusal_of([&] { add_trip(store, trip_record(9), long_trip()); }),
                    HasSubstr("a.gpkg: cannot be written: "));
    }
    EXPECT_EQ(store.digest(), before);
    EXPECT_EQ(StoreReader::open(file).digest(), before);
    EXPECT_TRUE(add_trip(store, trip_record(9), long_trip()));
}

TEST(StoreFaults, OfAFullDiskLeaveNoNewStore) {
    const auto folder = test_folder();
    {
        const FullDisk full{20000};
        EXPECT_THAT(refusal_of([&] { new_store(folder / "a.gpkg"); }), HasSubstr("a.gpkg: "));
    }
    EXPECT_TRUE(std::filesystem::is_empty(folder));
}

/// A store of two trips that nobody has open.
struct ClosedStore {
    std::filesystem::path file;
    std::string digest;
};

ClosedStore closed_store() {
    ClosedStore made{test_folder() / "a.gpkg", ""};
    auto store = new_store(made.file);
    import_trips(store, 2);
    made.digest = store.digest();
    return made;
}

TEST(StoreFaults, OfAWriterThatDiedAreUndoneByTheNextReader) {
    const auto [file, before] = closed_store();
    const auto child = fork_without_threads();
    if (child == 0) {
        Database database{file, Database::Access::write};
        database.run("PRAGMA cache_size = 1; BEGIN IMMEDIATE; DELETE FROM segment_state;"
                     "UPDATE pass SET iri_um = 1; UPDATE way SET name = zeroblob(100000)");
        ::_exit(0); // with the journal on disk and half of the pages overwritten
    }
    ::waitpid(child, nullptr, 0);
    auto journal = file;
    ASSERT_TRUE(std::filesystem::exists(journal += "-journal"));
    EXPECT_EQ(StoreReader::open(file).digest(), before);
}

/// As a killed import: what it committed stands in the log beside the store.
void add_trip_and_die(const std::filesystem::path& file, int number) {
    const auto child = fork_without_threads();
    if (child == 0) {
        auto store = RoadStore::open(file);
        add_trip(store, trip_record(number), passes_of(number));
        ::_exit(0);
    }
    ::waitpid(child, nullptr, 0);
    ASSERT_GT(std::filesystem::file_size(file.string() + "-wal"), 0U);
}

TEST(StoreFaults, OfAWriterThatDiedLeaveWhatItCommitted) {
    const auto [file, before] = closed_store();
    add_trip_and_die(file, 9);
    EXPECT_TRUE(StoreReader::open(file).contains_trip(trip_record(9).sha256));
}

TEST(StoreFaults, OfAnOldStoreStayOutOfANewOneOfItsName) {
    const auto [file, before] = closed_store();
    add_trip_and_die(file, 9);
    std::filesystem::remove(file); // and nobody thinks of the log
    new_store(file);
    EXPECT_EQ(StoreReader::open(file).info().trips, 0U);
}

TEST(StoreFaults, OfAnOldFileStayOutOfAnExportOfItsName) {
    const auto [file, before] = closed_store();
    const auto copy = file.parent_path() / "copy.gpkg";
    std::filesystem::copy_file(file, copy);
    add_trip_and_die(copy, 9);
    const auto store = StoreReader::open(file);
    const auto written = export_segments(store, {}, copy);
    Database database{copy, Database::Access::write};
    EXPECT_EQ(database.number("SELECT count(*) FROM roughness"), written);
    auto check = database.prepare("PRAGMA integrity_check");
    check.step();
    EXPECT_EQ(check.text(0), "ok");
}

// ------------------------------------------------------------------------- who else has it open

std::vector<std::string> names_in(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator{folder}) {
        names.push_back(entry.path().filename().string());
    }
    return names;
}

TEST(OpenStore, IsOneFileAgainWhenItIsClosed) {
    const auto [file, before] = closed_store();
    const auto bytes = [&] {
        std::ifstream in{file, std::ios::binary};
        return std::string(std::istreambuf_iterator<char>{in}, {});
    };
    EXPECT_THAT(names_in(file.parent_path()),
                ::testing::UnorderedElementsAre("a.gpkg", "a.gpkg.key"));
    // SQLite's file format, 1.3.3: 1 is a rollback journal, which any reader knows.
    EXPECT_EQ(bytes().substr(18, 2), "\1\1");
    {
        auto writer = RoadStore::open(file);
        add_trip(writer, trip_record(9), passes_of(9));
        EXPECT_EQ(bytes().substr(18, 2), "\2\2");
    }
    EXPECT_THAT(names_in(file.parent_path()),
                ::testing::UnorderedElementsAre("a.gpkg", "a.gpkg.key"));
    EXPECT_EQ(bytes().substr(18, 2), "\1\1");
}

TEST(OpenStore, IsReadAtItsLastCommitWhileItIsWritten) {
    const auto [file, before] = closed_store();
    Database writer{file, Database::Access::write};
    writer.enable_wal();
    const Transaction half{writer, Transaction::Kind::write};
    writer.run("DELETE FROM pass");
    EXPECT_EQ(StoreReader::open(file).digest(), before);
}

TEST(OpenStore, IsWrittenWhileItIsRead) {
    const auto [file, before] = closed_store();
    auto store = RoadStore::open(file);
    Database reader{file, Database::Access::read};
    const Transaction moment{reader, Transaction::Kind::read};
    const auto trips = reader.number("SELECT count(*) FROM trip");
    EXPECT_TRUE(add_trip(store, trip_record(9), passes_of(9)));
    EXPECT_EQ(reader.number("SELECT count(*) FROM trip"), trips);
}

TEST(OpenStore, IsWrittenWithoutALogWhileSomeoneReadsForLongAndWithOneAfterwards) {
    const auto [file, before] = closed_store();
    const auto mode_of = [&] { // SQLite's file format, 1.3.3: 1 is a rollback journal, 2 a log
        std::ifstream in{file, std::ios::binary};
        in.seekg(18);
        return in.get();
    };
    Database reader{file, Database::Access::read};
    std::optional<Transaction> long_moment{std::in_place, reader, Transaction::Kind::read};
    const auto passes = reader.number("SELECT count(*) FROM pass");
    Database writer{file, Database::Access::write};
    writer.enable_wal(std::chrono::milliseconds{20});
    {
        Transaction first{writer, Transaction::Kind::write};
        writer.run("DELETE FROM pass");
        EXPECT_EQ(mode_of(), 1);
        EXPECT_EQ(reader.number("SELECT count(*) FROM pass"), passes);
        long_moment.reset(); // or the commit waits for it
        first.commit();
    }
    const Transaction second{writer, Transaction::Kind::write};
    EXPECT_EQ(mode_of(), 2);
}

TEST(OpenStore, IsHandedOverByExportAsOneFile) {
    const auto [file, before] = closed_store();
    auto writer = RoadStore::open(file);
    add_trip(writer, trip_record(9), passes_of(9));
    writer.importer.refresh();
    const auto folder = file.parent_path() / "out";
    std::filesystem::create_directory(folder);
    const auto written = export_segments(StoreReader::open(file), {}, folder / "roads.gpkg");
    EXPECT_EQ(written, 20U);
    EXPECT_THAT(names_in(folder), ::testing::ElementsAre("roads.gpkg"));
}

/// Runs it as a user who may not write into the folder of the file; root may write anything.
template <typename Call>
void where_nothing_can_be_written(const std::filesystem::path& file, Call call) {
    namespace fs = std::filesystem;
    for (const auto& name : names_in(file.parent_path())) {
        fs::permissions(file.parent_path() / name, fs::perms{0444});
    }
    fs::permissions(file.parent_path(), fs::perms{0555});
    const auto user = ::geteuid();
    ASSERT_TRUE(user != 0 || ::seteuid(65534) == 0);
    call();
    ASSERT_TRUE(user != 0 || ::seteuid(0) == 0);
    fs::permissions(file.parent_path(), fs::perms{0755});
}

TEST(OpenStore, CopiedWhileItWasWrittenIsReadOnReadOnlyMedia) {
    const auto [file, before] = closed_store();
    const auto folder = file.parent_path() / "what? 100%#1"; // nothing in a name steers SQLite
    std::filesystem::create_directory(folder);
    const auto copy = folder / "b.gpkg";
    {
        const auto writer = RoadStore::open(file);
        std::filesystem::copy_file(file, copy);
    }
    std::string digest;
    where_nothing_can_be_written(copy, [&] { digest = StoreReader::open(copy).digest(); });
    EXPECT_EQ(digest, before);
}

TEST(OpenStore, CopiedWithALogButHalfOfItIsRefusedOnReadOnlyMedia) {
    const auto [file, before] = closed_store();
    add_trip_and_die(file, 9);
    std::filesystem::remove(file.string() + "-shm");
    std::string refusal;
    where_nothing_can_be_written(file,
                                 [&] { refusal = refusal_of([&] { StoreReader::open(file); }); });
    EXPECT_THAT(refusal,
                HasSubstr("a.gpkg: contains an interrupted import and is read-only, so it "
                          "cannot be rolled back: open it once where it can be written"));
}

// ---------------------------------------------------------------------------- what cannot be used

TEST(StoreFaults, OfReadOnlyMediaStopNoReader) {
    const auto file = test_folder() / "a.gpkg";
    std::string before;
    {
        auto store = new_store(file);
        import_trips(store, 2);
        before = store.digest();
    }
    std::filesystem::permissions(file, std::filesystem::perms{0444});
    std::filesystem::permissions(file.parent_path(), std::filesystem::perms{0555});
    const auto user = ::geteuid();
    ASSERT_TRUE(user != 0 || ::seteuid(65534) == 0); // root may write anything; nobody may not
    std::string digest, refusal;
    refusal = refusal_of([&] { RoadStore::open(file); });
    digest = StoreReader::open(file).digest();
    ASSERT_TRUE(user != 0 || ::seteuid(0) == 0);
    std::filesystem::permissions(file.parent_path(), std::filesystem::perms{0755});
    EXPECT_EQ(digest, before);
    EXPECT_THAT(refusal, HasSubstr("a.gpkg: cannot be written, it is read-only"));
}

TEST(StoreFaults, OfDamageAreNamed) {
    const auto file = test_folder() / "a.gpkg";
    new_store(file);
    {
        std::fstream out{file, std::ios::in | std::ios::out | std::ios::binary};
        out.seekp(4096);
        out << std::string(40000, '\x7f');
    }
    EXPECT_THAT(refusal_of([&] { StoreReader::open(file).digest(); }),
                HasSubstr("a.gpkg: is damaged: "));
}

TEST(StoreFaults, OfOtherGeoPackagesAndVersionsAreNamed) {
    const auto folder = test_folder();
    const auto refusal = [&] { return refusal_of([&] { StoreReader::open(folder / "a.gpkg"); }); };
    {
        Database other{folder / "a.gpkg", Database::Access::create};
        other.run("PRAGMA application_id = 1196444487; CREATE TABLE a(b)");
    }
    EXPECT_THAT(refusal(),
                HasSubstr("a.gpkg: is a GeoPackage, but not a Macadam database, expected one "
                          "made by 'macadam init'"));
    std::filesystem::remove(folder / "a.gpkg");
    new_store(folder / "a.gpkg");
    Database{folder / "a.gpkg", Database::Access::write}.run(
        "UPDATE meta SET value = '1' WHERE key = 'version'");
    EXPECT_THAT(refusal(), HasSubstr("is a database of version '1', expected version 7"));
}

/// What any tool for SQLite can do to a store.
std::filesystem::path changed_store(const std::string& sql) {
    const auto file = test_folder() / "a.gpkg";
    {
        auto store = new_store(file);
        import_trips(store, 2);
    }
    Database database{file, Database::Access::write};
    add_geometry_functions(database); // for the triggers, as is trust
    database.run("PRAGMA trusted_schema = ON;" + sql);
    return file;
}

TEST(StoreFaults, OfSettingsThatNobodyKnowsAreNamed) {
    const auto refusal = [](const std::string& sql) {
        const auto file = changed_store(sql);
        return refusal_of([&] { StoreReader::open(file); });
    };
    EXPECT_THAT(refusal("UPDATE meta SET value = 'none' WHERE key = 'class_table'"),
                HasSubstr("class_table is 'none', expected fhwa or five"));
    EXPECT_THAT(refusal("UPDATE meta SET value = '0' WHERE key = 'segment_length_m'"),
                HasSubstr("segment_length_m is '0', expected a length of segments"));
}

TEST(StoreFaults, OfAWayThatIsNoLineAreNamed) {
    for (const std::string change : {"node_ids = x''",
                                     "points = zeroblob(8)",
                                     "points = randomblob(0), node_ids = x''",
                                     "oneway = 7"}) {
        const auto file = changed_store("UPDATE way SET " + change + " WHERE way_id = 2");
        const auto store = StoreReader::open(file);
        EXPECT_THAT(refusal_of([&] { store.roads(); }),
                    HasSubstr("way '2' has no valid line geometry"))
            << change;
    }
}

TEST(StoreFaults, OfASegmentWithoutALineAreNamed) {
    const auto file = changed_store("UPDATE segment SET geom = x'4750' WHERE seq = 3");
    const auto store = StoreReader::open(file);
    EXPECT_THAT(refusal_of([&] { store.visit({}, [](const SegmentRecord&) {}); }),
                HasSubstr("segment '1+0003' has no valid line"));
}

TEST(StoreFaults, OfATimeBeyondAllYearsLeaveItUnknown) {
    const auto file = changed_store("UPDATE trip SET t0_utc_ms = 9223372036854775807;"
                                    "UPDATE pass SET t_ms = 9223372036854775807;"
                                    "UPDATE segment_state SET last_seen_ms = -9223372036854775808");
    const auto store = StoreReader::open(file);
    EXPECT_EQ(store.history({1, true, 0}).at(0).utc_ms, std::nullopt);
    EXPECT_EQ(store.info().last_seen_ms, std::nullopt);
}

TEST(Sqlite, SaysThatTheDiskIsFull) {
    Database database{test_folder() / "a.db", Database::Access::create};
    database.run("PRAGMA max_page_count = 3; CREATE TABLE a(b)");
    EXPECT_THAT(refusal_of([&] { database.run("INSERT INTO a VALUES (zeroblob(100000))"); }),
                HasSubstr("a.db: no space left on the disk, nothing was changed"));
}

TEST(Sqlite, SaysThatAnotherHoldsTheFile) {
    const auto file = test_folder() / "a.db";
    Database{file, Database::Access::create}.run("CREATE TABLE a(b)");
    Database one{file, Database::Access::write};
    Database other{file, Database::Access::write};
    other.run("PRAGMA busy_timeout = 0");
    const Transaction held{one, Transaction::Kind::write};
    EXPECT_THAT(refusal_of([&] {
                    Transaction{other, Transaction::Kind::write};
                }),
                HasSubstr("a.db: is locked by another program"));
}

TEST(AtomicFile, AppearsWhenItIsWhole) {
    const auto file = test_folder() / "a.txt";
    AtomicFile out{file};
    out.write("whole");
    EXPECT_TRUE(std::filesystem::is_empty(file.parent_path())); // it has no name before
    out.commit();
    std::ifstream in{file};
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>{in}, {}), "whole");
}

TEST(AtomicFile, LeavesNothingWithoutCommit) {
    const auto folder = test_folder();
    { AtomicFile{folder / "a.txt"}.write("half"); }
    EXPECT_TRUE(std::filesystem::is_empty(folder));
}

TEST(AtomicFile, KeepsTheOldFileOnAFullDisk) {
    const auto file = testing::written(test_folder(), "a.txt", "old");
    {
        const FullDisk full{10000};
        EXPECT_THAT(refusal_of([&] {
                        AtomicFile out{file};
                        out.write(std::string(50000, 'x'));
                        out.commit();
                    }),
                    HasSubstr("a.txt: cannot be written: File too large"));
    }
    std::ifstream in{file};
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>{in}, {}), "old");
}

} // namespace
} // namespace macadam
