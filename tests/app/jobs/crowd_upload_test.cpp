// Contributors of a crowd's database on PostgreSQL: from their uploads to what the public sees, and
// back.

#include "app/jobs/upload_server.hpp"
#include "support/program/postgres_server.hpp"
#include "support/program/program.hpp"
#include "support/roads/crowd_logs.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;
using Clock = std::chrono::steady_clock;

macadam::testing::Run run(const std::vector<std::string>& words) {
    auto done = run_macadam(words);
    EXPECT_EQ(done.exit_status, 0) << words.front() << ": " << done.out << done.err;
    return done;
}

/// Database of a crowd on a server, with contributors Anna and Ben. One log was submitted by its
/// operator, who so named the object store.
struct CrowdWorld {
    static std::string made(const fs::path& folder, PostgresServer& postgres) {
        auto address = postgres.new_database("roads");
        write_file(folder / "road.osm", crowd_road_osm());
        write_file(folder / "own.trip.csv", crowd_logs(6).back());
        run({"init", address, "--network", (folder / "road.osm").string(), "--privacy", "crowd"});
        run({"submit",
             address,
             (folder / "own.trip.csv").string(),
             "--objects",
             (folder / "objects").string()});
        return address;
    }

    void work() const { run({"worker", address, "--once", "--method", "kf", "--quiet"}); }

    /// Hashes of the uploads that a token lists.
    std::vector<std::string> listed(std::string_view token) const {
        std::vector<std::string> hashes;
        const auto page = nlohmann::json::parse(server.ask("GET", "/v1/trips", token).body);
        for (const auto& trip : page.at("trips")) {
            hashes.push_back(trip.at("sha256"));
        }
        return hashes;
    }

    /// Number of segments with values that a token sees; "": the public.
    int segments(std::string_view token) const {
        const auto answer =
            server.ask("GET", "/collections/segments/items?limit=1&filter=passes%20%3E%200", token);
        EXPECT_EQ(answer.status, 200) << answer.body;
        return nlohmann::json::parse(answer.body).at("numberMatched");
    }

    /// Number of passes over the middle of the road, for who holds the key.
    std::ptrdiff_t passes() const {
        const auto table =
            run({"query", address, "--segment", "7+0005", "--passes", "--format", "csv"}).out;
        return std::ranges::count(table, '\n') - 1; // its head
    }

    /// Files of logs that wait, or are kept.
    std::vector<std::string> objects() const {
        std::vector<std::string> names;
        for (const auto& each : fs::recursive_directory_iterator{folder / "objects"}) {
            if (each.is_regular_file()) {
                names.push_back(each.path().filename());
            }
        }
        return names;
    }

    fs::path folder = fresh_folder();
    PostgresServer postgres;
    std::string address = made(folder, postgres);
    UploadServer server{address};
    std::string anna = server.token("anna", "upload");
    std::string ben = server.token("ben", "upload");
    std::string office = server.token("office", "operator");
};

TEST(CrowdUpload, IsErasedOnceWorkedOutAndPublicOnlyByAPublication) {
    CrowdWorld world;
    world.server.start();
    const auto logs = crowd_logs(5);
    for (std::size_t i = 0; i < logs.size(); ++i) {
        const auto answer = world.server.put(logs[i], i < 3 ? world.anna : world.ben);
        EXPECT_EQ(answer.status, 202) << answer.body;
    }
    EXPECT_THAT(world.objects(), SizeIs(6));
    world.work();
    EXPECT_THAT(world.objects(), IsEmpty()); // not one raw log
    for (std::size_t i = 0; i < logs.size(); ++i) {
        EXPECT_EQ(world.server.state(logs[i], i < 3 ? world.anna : world.ben), "imported");
    }

    EXPECT_EQ(world.passes(), 6);
    for (const auto& token : {std::string{}, world.anna, world.office}) {
        EXPECT_EQ(world.segments(token), 0);
    }

    run({"publish", world.address});
    int published = 0; // the server follows the database
    for (const auto end = Clock::now() + 60s; Clock::now() < end && published == 0;) {
        std::this_thread::sleep_for(100ms);
        published = world.segments("");
    }
    EXPECT_GT(published, 0);
    EXPECT_EQ(world.segments(world.anna), published);

    ASSERT_EQ(world.server.ask("DELETE", target_of(logs[0]), world.anna).status, 202);
    world.work();
    EXPECT_EQ(world.server.ask("GET", target_of(logs[0]), world.anna).status, 404);
    EXPECT_EQ(world.passes(), 5);
    EXPECT_EQ(world.segments(""), published); // which stays as it is until the next one

    EXPECT_EQ(world.server.put(logs[0], world.anna).status, 202);
    world.work();
    EXPECT_EQ(world.server.state(logs[0], world.anna), "known"); // it stays forgotten
    EXPECT_EQ(world.passes(), 5);
    EXPECT_THAT(world.objects(), IsEmpty());
}

TEST(CrowdUpload, IsSeenAndDeletedByItsContributorAlone) {
    CrowdWorld world;
    world.server.start();
    const auto logs = crowd_logs(3);
    ASSERT_EQ(world.server.put(logs[0], world.anna).status, 202);
    ASSERT_EQ(world.server.put(logs[1], world.ben).status, 202);
    ASSERT_EQ(world.server.put(logs[2], world.ben).status, 202);
    const auto of_others = [&] { // asked by the other one, before and after it is worked out
        for (const auto* const method : {"GET", "DELETE"}) {
            EXPECT_EQ(world.server.ask(method, target_of(logs[0]), world.ben).status, 404);
            EXPECT_EQ(world.server.ask(method, target_of(logs[1]), world.anna).status, 404);
            EXPECT_EQ(world.server.ask(method, target_of(logs[1]), "").status, 401);
        }
        const auto sent_again = world.server.put(logs[0], world.ben); // he has the log himself
        EXPECT_EQ(sent_again.status, 200);
        EXPECT_THAT(sent_again.body, HasSubstr("\"state\":\"known\""));
        EXPECT_THAT(sent_again.body, Not(HasSubstr("passes")));
        EXPECT_EQ(world.listed(world.anna), std::vector<std::string>{sha256_of(logs[0])});
        EXPECT_THAT(world.listed(world.ben), SizeIs(2));
        EXPECT_THAT(world.listed(world.office), SizeIs(4)); // with the one that was submitted
        EXPECT_EQ(world.server.ask("GET", "/collections/trips/items", world.anna).status, 403);
        EXPECT_EQ(world.server.ask("GET", "/queue/status", world.anna).status, 403);
    };
    of_others();
    EXPECT_EQ(world.server.ask("DELETE", target_of(logs[2]), world.ben).status, 204);
    EXPECT_THAT(world.objects(), SizeIs(3));
    ASSERT_EQ(world.server.put(logs[2], world.ben).status, 202);
    world.work();
    of_others();
    EXPECT_EQ(world.server.state(logs[0], world.anna), "imported");
    EXPECT_EQ(world.server.state(logs[1], world.ben), "imported");
}

} // namespace
} // namespace macadam::testing
