// `macadam upgrade` of a store that an earlier program made, as users run it.

#include "storage/sqlite/sqlite.hpp"
#include "storage/store/privacy/privacy_key.hpp"
#include "support/program/program.hpp"
#include "support/roads/old_store.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <csignal>
#include <cstdlib>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;
using ::testing::StartsWith;
using Json = nlohmann::json;

class UpgradeProgram : public ::testing::Test {
protected:
    void SetUp() override {
        folder_ = fresh_folder();
        store_ = put_store_of_version_2(folder_).string();
    }

    macadam::testing::Run run(const std::string& command,
                              std::vector<std::string> words = {}) const {
        words.insert(words.begin(), {command, store_});
        return run_macadam(words);
    }

    fs::path folder_;
    std::string store_;
};

TEST_F(UpgradeProgram, IsWhatEveryOtherCommandAsksFor) {
    const auto content = read_file(store_);
    for (const auto& [command, words] :
         std::vector<std::pair<std::string, std::vector<std::string>>>{
             {"info", {}},
             {"query", {"--worst", "1"}},
             {"export", {"-o", (folder_ / "a.geojson").string()}},
             {"forget", {"--vehicle-id", "van-7"}},
             {"calibrate", {}}}) {
        const auto refused = run(command, words);
        EXPECT_EQ(refused.exit_status, 1) << command;
        EXPECT_THAT(refused.err,
                    HasSubstr("is a database of version 2, expected version 7: run 'macadam "
                              "upgrade " +
                              store_ + "', which keeps all content"));
    }
    EXPECT_EQ(read_file(store_), content);
}

TEST_F(UpgradeProgram, KeepsTheDigestAndNamesTheCarsUnderAKey) {
    const auto done = run("upgrade", {"--json"});
    ASSERT_EQ(done.exit_status, 0) << done.err;
    const auto json = Json::parse(done.out);
    EXPECT_EQ(json["from_version"], 2);
    EXPECT_EQ(json["to_version"], 7);
    EXPECT_EQ(json["cars"], 2);
    EXPECT_EQ(json["trips_renamed"], 5);
    EXPECT_EQ(json["digest"], digest_of_version_2);
    EXPECT_EQ(run("info", {"--digest"}).out, std::string{digest_of_version_2} + "\n");

    const auto info = Json::parse(run("info", {"--json"}).out);
    EXPECT_EQ(info["privacy"], "own");
    EXPECT_EQ(info["operator"], true);
    const auto key = *read_key(store_ + ".key");
    EXPECT_EQ(info["vehicles"][0], key.pseudonym("van-7"));
    EXPECT_EQ(info["vehicles"][1], key.pseudonym("van-8"));
    EXPECT_THAT(run("info", {"--audit"}).out, HasSubstr("from version 2 to 7"));
    EXPECT_EQ(run("forget", {"--trip", "van-7-0002"}).exit_status, 0);
    EXPECT_EQ(run("forget", {"--vehicle-id", "van-8"}).exit_status, 0);
}

TEST_F(UpgradeProgram, LeavesNoByteOfOldNamesOrTimes) {
    ASSERT_THAT(read_file(store_), HasSubstr("van-7-0002"));
    ASSERT_EQ(run("upgrade").exit_status, 0);
    const auto bytes = read_file(store_);
    for (const auto* const old :
         {"van-7", "van-8", "v-ebce06789279", "v-f8f037686475", "2025-03-29T"}) {
        EXPECT_EQ(bytes.find(old), std::string::npos) << old;
    }
    for (const auto* const beside : {"-wal", "-journal", "-shm"}) {
        EXPECT_FALSE(fs::exists(store_ + beside));
    }
}

TEST_F(UpgradeProgram, HasNothingToDoASecondTime) {
    EXPECT_THAT(run("upgrade").out,
                HasSubstr("upgraded from version 2 to 7; 2 cars "
                          "pseudonymised with the key"));
    const auto content = read_file(store_);
    const auto again = run("upgrade");
    EXPECT_EQ(again.exit_status, 0);
    EXPECT_THAT(again.out, HasSubstr("roads.gpkg: is already of version 7, nothing to do"));
    EXPECT_EQ(read_file(store_), content);
}

TEST_F(UpgradeProgram, TellsOfPotholesAndBackgroundsOnlyWhereTheVersionHadNone) {
    const auto background = "run 'macadam init " + store_ + " --update MAP' for water";
    EXPECT_THAT(run("upgrade").out,
                AllOf(HasSubstr("run 'macadam reprocess'"), HasSubstr(background)));
    const auto make_version = [&](const std::string& version) {
        Database{store_, Database::Access::write}.run(
            "ALTER TABLE trip DROP COLUMN trimmed_mm; UPDATE meta SET value = '" + version +
            "' WHERE key = 'version'");
    };
    make_version("5");
    EXPECT_THAT(run("upgrade").out,
                AllOf(HasSubstr("upgraded from version 5 to 7"),
                      Not(HasSubstr("reprocess")),
                      HasSubstr(background)));
    make_version("6");
    EXPECT_THAT(run("upgrade").out,
                AllOf(HasSubstr("upgraded from version 6 to 7"),
                      Not(HasSubstr("reprocess")),
                      Not(HasSubstr("init"))));
}

TEST_F(UpgradeProgram, RefusesAStoreOfANewerProgramOrWithViewsOfOthers) {
    const auto change = [&](const char* sql) {
        Database{store_, Database::Access::write}.run(sql);
    };
    change("CREATE VIEW x AS SELECT 1");
    EXPECT_THAT(run("upgrade").err,
                HasSubstr("contains a view 'x' that does not belong to "
                          "Macadam"));
    EXPECT_THAT(run("info").err, HasSubstr("contains a view 'x' that does not belong to Macadam"));
    change("DROP VIEW x; UPDATE meta SET value = '8' WHERE key = 'version'");
    const auto newer = run("upgrade");
    EXPECT_EQ(newer.exit_status, 1);
    EXPECT_THAT(newer.err,
                HasSubstr("is a database of version '8', expected version 7: it was made by a "
                          "newer version of Macadam"));
    EXPECT_FALSE(fs::exists(store_ + ".key"));
}

TEST_F(UpgradeProgram, LeavesTheOldStoreWhereTheDiskIsFull) {
    const auto content = read_file(store_);
    const auto full = run_macadam({"upgrade", store_}, content.size() + 5000);
    EXPECT_EQ(full.exit_status, 1);
    EXPECT_THAT(full.err, HasSubstr("roads.gpkg: "));
    EXPECT_THAT(run("info").err, HasSubstr("run 'macadam upgrade"));
    EXPECT_THAT(run("upgrade").out, HasSubstr(digest_of_version_2));
}

TEST_F(UpgradeProgram, KilledAtAnyMomentLeavesTheOldStoreOrTheNewOne) {
    using Clock = std::chrono::steady_clock;
    const int kills = std::getenv("MACADAM_TEST_ALL") != nullptr ? 200 : 15;
    int cut_off = 0;
    for (int i = 0; i < kills; ++i) {
        fs::remove(store_ + ".key");
        put_store_of_version_2(folder_);
        // Later each time: it takes some hundredths of a second in all.
        const auto when = Clock::now() + std::chrono::milliseconds{200} * i / kills;
        const auto killed = run_macadam_signalled(
            {"upgrade", store_}, [&] { return Clock::now() >= when; }, SIGKILL);
        cut_off += killed.exit_status != 0 ? 1 : 0;
        const auto again = run("upgrade");
        EXPECT_THAT(again.out, AnyOf(HasSubstr(digest_of_version_2), HasSubstr("nothing to do")))
            << again.err;
        const auto info = run("info", {"--digest"});
        EXPECT_THAT(info.out, StartsWith(digest_of_version_2)) << info.err;
        EXPECT_EQ(Json::parse(run("info", {"--json"}).out)["operator"], true);
    }
    EXPECT_GT(cut_off, 0);
}

} // namespace
} // namespace macadam::testing
