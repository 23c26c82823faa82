#include "storage/road_store.hpp"

#include "files.hpp"
#include "storage/atomic_file.hpp"
#include "storage/geopackage.hpp"
#include "storage/sqlite.hpp"
#include "store_world.hpp"

#include <gmock/gmock.h>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

namespace macadam {
namespace {

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
        EXPECT_THAT(refusal_of([&] { store.add_trip(trip_record(9), long_trip()); }),
                    HasSubstr("a.gpkg: cannot be written: "));
    }
    EXPECT_EQ(store.digest(), before);
    EXPECT_EQ(RoadStore::open(file, RoadStore::Access::read).digest(), before);
    EXPECT_TRUE(store.add_trip(trip_record(9), long_trip()));
}

TEST(StoreFaults, OfAFullDiskLeaveNoNewStore) {
    const auto folder = test_folder();
    {
        const FullDisk full{20000};
        EXPECT_THAT(refusal_of([&] { new_store(folder / "a.gpkg"); }), HasSubstr("a.gpkg: "));
    }
    EXPECT_TRUE(std::filesystem::is_empty(folder));
}

TEST(StoreFaults, OfAWriterThatDiedAreUndoneByTheNextReader) {
    const auto file = test_folder() / "a.gpkg";
    auto store = new_store(file);
    import_trips(store, 2);
    const auto before = store.digest();
    const auto child = ::fork();
    if (child == 0) {
        Database database{file, Database::Access::write};
        database.run("PRAGMA cache_size = 1; BEGIN IMMEDIATE; DELETE FROM segment_state;"
                     "UPDATE pass SET iri_um = 1; UPDATE way SET name = zeroblob(100000)");
        ::_exit(0); // with the journal on disk and half of the pages overwritten
    }
    ::waitpid(child, nullptr, 0);
    auto journal = file;
    ASSERT_TRUE(std::filesystem::exists(journal += "-journal"));
    EXPECT_EQ(RoadStore::open(file, RoadStore::Access::read).digest(), before);
}

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
    refusal = refusal_of([&] { RoadStore::open(file, RoadStore::Access::write); });
    digest = RoadStore::open(file, RoadStore::Access::read).digest();
    ASSERT_TRUE(user != 0 || ::seteuid(0) == 0);
    std::filesystem::permissions(file.parent_path(), std::filesystem::perms{0755});
    EXPECT_EQ(digest, before);
    EXPECT_THAT(refusal, HasSubstr("a.gpkg: cannot be written, it is read-only"));
}

TEST(StoreFaults, OfAReaderThatWritesAreRefused) {
    const auto file = test_folder() / "a.gpkg";
    new_store(file);
    auto reader = RoadStore::open(file, RoadStore::Access::read);
    EXPECT_THAT(refusal_of([&] { reader.add_trip(trip_record(0), passes_of(0)); }),
                HasSubstr("a.gpkg: cannot be written, it is read-only"));
}

TEST(StoreFaults, OfDamageAreNamed) {
    const auto file = test_folder() / "a.gpkg";
    new_store(file);
    {
        std::fstream out{file, std::ios::in | std::ios::out | std::ios::binary};
        out.seekp(4096);
        out << std::string(40000, '\x7f');
    }
    EXPECT_THAT(refusal_of([&] { RoadStore::open(file, RoadStore::Access::read).digest(); }),
                HasSubstr("a.gpkg: is damaged: "));
}

TEST(StoreFaults, OfOtherGeoPackagesAndVersionsAreNamed) {
    const auto folder = test_folder();
    const auto refusal = [&] {
        return refusal_of([&] { RoadStore::open(folder / "a.gpkg", RoadStore::Access::read); });
    };
    {
        Database other{folder / "a.gpkg", Database::Access::create};
        other.run("PRAGMA application_id = 1196444487; CREATE TABLE a(b)");
    }
    EXPECT_THAT(refusal(),
                HasSubstr("a.gpkg: is a GeoPackage but no Macadam store, expected one made by "
                          "'macadam init'"));
    std::filesystem::remove(folder / "a.gpkg");
    new_store(folder / "a.gpkg");
    Database{folder / "a.gpkg", Database::Access::write}.run(
        "UPDATE meta SET value = '1' WHERE key = 'version'");
    EXPECT_THAT(refusal(), HasSubstr("is a store of version '1', expected version 2"));
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
        return refusal_of([&] { RoadStore::open(file, RoadStore::Access::read); });
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
        const auto store = RoadStore::open(file, RoadStore::Access::read);
        EXPECT_THAT(refusal_of([&] { store.roads(); }), HasSubstr("way '2' is no line")) << change;
    }
}

TEST(StoreFaults, OfASegmentWithoutALineAreNamed) {
    const auto file = changed_store("UPDATE segment SET geom = x'4750' WHERE seq = 3");
    const auto store = RoadStore::open(file, RoadStore::Access::read);
    EXPECT_THAT(refusal_of([&] { store.visit({}, [](const SegmentRecord&) {}); }),
                HasSubstr("segment '1+0003' has no line"));
}

TEST(StoreFaults, OfATimeBeyondAllYearsLeaveItUnknown) {
    const auto file = changed_store("UPDATE trip SET t0_utc_ms = 9223372036854775807;"
                                    "UPDATE pass SET t_ms = 9223372036854775807;"
                                    "UPDATE segment_state SET last_seen_ms = -9223372036854775808");
    const auto store = RoadStore::open(file, RoadStore::Access::read);
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
    EXPECT_FALSE(std::filesystem::exists(file));
    out.commit();
    std::ifstream in{file};
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>{in}, {}), "whole");
    EXPECT_FALSE(std::filesystem::exists(out.temporary()));
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
