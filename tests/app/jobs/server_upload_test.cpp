// Uploads to a server of a database on PostgreSQL, as a client sees them, up to the worker.

#include "app/jobs/upload_server.hpp"
#include "app/jobs/worker_world.hpp"
#include "storage/postgres/server_connection.hpp"
#include "support/http/http_client.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using namespace nlohmann::literals;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using Clock = std::chrono::steady_clock;

constexpr auto patience = 60s; // of a machine that is busy

std::size_t files_below(const fs::path& folder) {
    std::size_t count = 0;
    for (const auto& each : fs::recursive_directory_iterator{folder}) {
        count += each.is_regular_file() ? 1U : 0U;
    }
    return count;
}

/// Database on a server with tokens, a server of it that runs, and logs to send.
struct UploadWorld : WorkerWorld {
    explicit UploadWorld(bool has_objects = true) {
        make_trips(3);
        if (has_objects) { // as the first submission does
            EXPECT_EQ(run_macadam({"submit",
                                   address,
                                   (trips / "00002.trip.csv").string(),
                                   "--objects",
                                   objects,
                                   "--quiet"})
                          .exit_status,
                      0);
        }
        server.start();
    }

    std::string log(int number) const {
        return read_file(trips / fmt::format("{:05}.trip.csv", number));
    }

    void work() const {
        const auto worker = run_macadam(worker_words());
        EXPECT_EQ(worker.exit_status, 0) << worker.err;
    }

    UploadServer server{address};
    std::string office = server.token("office", "operator");
};

TEST(ServerUpload, IsImportedByAWorkerAndTakenOutAgain) {
    const UploadWorld world;
    world.work(); // on what was submitted
    const auto before = world.digest();
    const auto log = world.log(0);
    const auto first = world.server.put(log, world.office);
    EXPECT_EQ(first.status, 202) << first.body;
    EXPECT_EQ(first.headers.at("location"), target_of(log));
    EXPECT_EQ(files_below(world.objects), 1U);
    EXPECT_EQ(world.server.put(log, world.office).status, 200); // known
    EXPECT_EQ(world.server.state(log, world.office), "queued");
    world.work();
    const auto fate =
        nlohmann::json::parse(world.server.ask("GET", target_of(log), world.office).body);
    EXPECT_EQ(fate.at("state"), "imported");
    EXPECT_EQ(fate.at("trips"), 1);
    EXPECT_GT(fate.at("passes"), 10);
    EXPECT_EQ(files_below(world.objects), 0U);
    EXPECT_NE(world.digest(), before);

    EXPECT_EQ(world.server.ask("DELETE", target_of(log), world.office).status, 202);
    EXPECT_EQ(world.server.state(log, world.office), "deleting");
    world.work();
    EXPECT_EQ(world.server.ask("GET", target_of(log), world.office).status, 404);
    EXPECT_EQ(world.digest(), before);
}

TEST(ServerUpload, IsTakenOnlyWithItsHashAndAToken) {
    const UploadWorld world;
    const auto log = world.log(0);
    EXPECT_EQ(world.server.ask("PUT", target_of("another log"), world.office, log).status, 422);
    EXPECT_EQ(world.server.put(log, "").status, 401);
    EXPECT_EQ(world.server.put(log, "mac_00000000_" + std::string(64, '0')).status, 401);
    const auto reader = world.server.token("reader", "read");
    ASSERT_TRUE(world.server.await("/v1/trips", reader, 403));
    EXPECT_EQ(world.server.put(log, reader).status, 403);
    EXPECT_EQ(files_below(world.objects), 1U); // that was submitted
    EXPECT_EQ(world.server.ask("GET", target_of(log), world.office).status, 404);
}

TEST(ServerUpload, IsRefusedWithWordsWhereNoObjectStoreIsKnown) {
    const UploadWorld world{false};
    const auto answer = world.server.put(world.log(0), world.office);
    EXPECT_EQ(answer.status, 503);
    EXPECT_THAT(answer.body, HasSubstr("macadam submit --objects"));
}

TEST(ServerUpload, IsSeenAndDeletedByItsSenderAlone) {
    UploadWorld world;
    const auto anna = world.server.token("anna", "operator"),
               ben = world.server.token("ben", "upload");
    ASSERT_TRUE(world.server.await("/v1/trips", ben, 200));
    const auto log = world.log(0);
    EXPECT_EQ(world.server.put(log, ben).status, 403); // not a crowd's
    ASSERT_EQ(world.server.put(log, anna).status, 202);
    EXPECT_EQ(world.server.ask("GET", target_of(log), ben).status, 404);
    EXPECT_EQ(world.server.ask("DELETE", target_of(log), ben).status, 404);
    EXPECT_THAT(world.server.ask("GET", "/v1/trips", ben).body, Not(HasSubstr(sha256_of(log))));
    EXPECT_THAT(world.server.ask("GET", "/v1/trips", anna).body, HasSubstr(sha256_of(log)));
    EXPECT_EQ(world.server.ask("DELETE", target_of(log), anna).status, 204); // nobody has begun it
    EXPECT_EQ(files_below(world.objects), 1U);
    EXPECT_EQ(run_macadam({"token", "revoke", world.address, "ben"}).exit_status, 0);
    EXPECT_TRUE(world.server.await("/v1/trips", ben, 401));
}

TEST(ServerUpload, IsLostByNoKillAfterItsAnswer) {
    UploadWorld world;
    for (int i = 0; i < 2; ++i) {
        ASSERT_EQ(world.server.put(world.log(i), world.office).status, 202);
        world.server.kill();
        world.server.start();
    }
    world.work();
    expect_all_imported(world, 3);
}

TEST(ServerUpload, IsSeenInTheQueueByOperatorsAlone) {
    const UploadWorld world;
    ASSERT_EQ(world.server.put(world.log(0), world.office).status, 202);
    const auto ben = world.server.token("ben", "upload");
    ASSERT_TRUE(world.server.await("/v1/trips", ben, 200));
    EXPECT_EQ(world.server.ask("GET", "/queue/status", ben).status, 403);
    EXPECT_EQ(world.server.ask("GET", "/queue/status", "").status, 401);
    std::string status; // read at most every 5 s
    for (const auto end = Clock::now() + patience;
         Clock::now() < end && status.find("\"queued\":2") == std::string::npos;) {
        std::this_thread::sleep_for(100ms);
        status = world.server.ask("GET", "/queue/status", world.office).body;
    }
    EXPECT_THAT(status, AllOf(HasSubstr("\"queued\":2"), HasSubstr("\"accepted_in_hour\":2")));
    const auto described = nlohmann::json::parse(get(world.server.port(), "/api").body)
                               .at("/paths/~1queue~1status/get/responses/200/content"_json_pointer)
                               .at("/application~1json/schema/properties/queue"_json_pointer);
    const auto queue = nlohmann::json::parse(status).at("queue");
    for (const auto& name : described.at("required")) {
        EXPECT_TRUE(queue.contains(name)) << name;
    }
    EXPECT_EQ(queue.size(), described.at("required").size());
    const auto metrics = get(world.server.port(), "/metrics").body;
    EXPECT_THAT(metrics,
                AllOf(HasSubstr("macadam_http_requests_total"),
                      HasSubstr("macadam_queue_up 1\n"),
                      HasSubstr("macadam_queue_logs{state=\"queued\"} 2\n")));
    ServerConnection database{world.address};
    database.run("ALTER TABLE macadam.worker RENAME TO gone");
    std::string without = metrics;
    for (const auto end = Clock::now() + patience;
         Clock::now() < end && without.find("macadam_queue_up 0\n") == std::string::npos;) {
        std::this_thread::sleep_for(100ms);
        without = get(world.server.port(), "/metrics").body;
    }
    EXPECT_THAT(without,
                AllOf(HasSubstr("macadam_http_requests_total"),
                      HasSubstr("macadam_queue_up 0\n"),
                      Not(HasSubstr("macadam_queue_logs"))));
    database.run("ALTER TABLE macadam.gone RENAME TO worker");
}

/// Database of the server of this process that nobody can connect to, for as long as this lives.
class DatabaseAway {
public:
    explicit DatabaseAway(const std::string& address)
        : name_{address.substr(address.find("@/") + 2, address.find('?') - address.find("@/") - 2)},
          superuser_{"postgresql://boss@/postgres" + address.substr(address.find('?'))} {
        superuser_.run(fmt::format("ALTER DATABASE {} ALLOW_CONNECTIONS false", name_));
        superuser_.rows(
            "SELECT pg_terminate_backend(pid, 10000) FROM pg_stat_activity WHERE datname = $1",
            {name_});
    }
    DatabaseAway(const DatabaseAway&) = delete;
    DatabaseAway& operator=(const DatabaseAway&) = delete;
    ~DatabaseAway() {
        superuser_.run(fmt::format("ALTER DATABASE {} ALLOW_CONNECTIONS true", name_));
    }

private:
    std::string name_;
    ServerConnection superuser_;
};

void expect_to_come_again(const Answer& answer) {
    EXPECT_EQ(answer.status, 503) << answer.body;
    EXPECT_EQ(answer.headers.at("retry-after"), "60");
    EXPECT_THAT(answer.body, HasSubstr("cannot be"));
    EXPECT_THAT(answer.body, Not(HasSubstr("postgresql"))); // why, for the operator alone
}

TEST(ServerUpload, IsAskedForAgainWhenTheDatabaseGoesAwayMeanwhile) {
    const UploadWorld world;
    const auto log = world.log(0);
    const auto head = [&](std::string_view method) {
        return fmt::format("{} {} HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer {}\r\n"
                           "Content-Type: text/csv\r\n",
                           method,
                           target_of(log),
                           world.office);
    };
    ASSERT_EQ(world.server.ask("GET", target_of(log), world.office).status, 404); // it is up
    {
        HttpClient client{world.server.port()};
        client.send(head("PUT") +
                    fmt::format("Content-Length: {}\r\nExpect: 100-continue\r\n\r\n", log.size()));
        ASSERT_THAT(client.read_until("\r\n\r\n"), HasSubstr("100 Continue")); // it is admitted
        const DatabaseAway away{world.address};
        client.send(log);
        expect_to_come_again(client.answer());
        for (const auto* const method : {"GET", "DELETE"}) {
            HttpClient another{world.server.port()};
            another.send(head(method) + "\r\n");
            expect_to_come_again(another.answer());
        }
        EXPECT_EQ(files_below(world.objects), 1U); // that was submitted
        for (const auto& each : fs::recursive_directory_iterator{std::getenv("XDG_CACHE_HOME")}) {
            EXPECT_THAT(each.path().string(), Not(HasSubstr(sha256_of(log))));
        }
    }
    ASSERT_TRUE(world.server.await("/v1/trips", world.office, 200));
    EXPECT_EQ(world.server.ask("GET", target_of(log), world.office).status, 404);
    EXPECT_EQ(world.server.put(log, world.office).status, 202);
    EXPECT_EQ(files_below(world.objects), 2U);
    world.work();
    EXPECT_EQ(world.server.state(log, world.office), "imported");
    EXPECT_EQ(files_below(world.objects), 0U);
}

} // namespace
} // namespace macadam::testing
