// Uploads to a server of a database on PostgreSQL, as a client sees them, up to the worker.

#include "app/jobs/worker_world.hpp"
#include "storage/files/sha256.hpp"
#include "storage/postgres/server_connection.hpp"
#include "support/http/http_client.hpp"
#include "support/program/piped_program.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using Clock = std::chrono::steady_clock;

constexpr auto patience = 60s; // of a machine that is busy

std::string sha256_of(std::string_view bytes) {
    Sha256 hash;
    hash.add(bytes);
    return hash.hex();
}

std::string target_of(std::string_view log) {
    return "/v1/trips/" + sha256_of(log);
}

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
        start();
    }

    std::string log(int number) const {
        return read_file(trips / fmt::format("{:05}.trip.csv", number));
    }

    std::string token(const std::string& owner, const std::string& scope) const {
        auto text = run_macadam({"token", "create", address, owner, "--scope", scope, "--quiet"});
        EXPECT_EQ(text.exit_status, 0) << text.err;
        text.out.erase(text.out.find_last_not_of('\n') + 1);
        return text.out;
    }

    void start() {
        server = std::make_unique<PipedProgram>(std::vector<std::string>{
            "serve", address, "--listen", fmt::format("127.0.0.1:{}", port), "--quiet"});
        for (const auto end = Clock::now() + patience; Clock::now() < end;) {
            if (get(port, "/health").status == 200) {
                return;
            }
            std::this_thread::sleep_for(10ms);
        }
        ADD_FAILURE() << "the server does not answer";
    }

    /// Asks, and again while a busy machine keeps the server from checking tokens.
    Answer ask(std::string_view method,
               std::string_view target,
               std::string_view token,
               std::string_view body = {}) const {
        Answer answer;
        for (const auto end = Clock::now() + patience; Clock::now() < end;) {
            HttpClient client{port};
            client.send(fmt::format(
                "{} {} HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer "
                "{}\r\nContent-Type: text/csv\r\n{}\r\n{}",
                method,
                target,
                token,
                body.empty() ? std::string{} : fmt::format("Content-Length: {}\r\n", body.size()),
                body));
            answer = client.answer();
            if (answer.status != 503 || answer.body.find("cannot be") == std::string::npos) {
                break;
            }
            std::this_thread::sleep_for(100ms);
        }
        return answer;
    }

    Answer put(std::string_view log, std::string_view token) const {
        return ask("PUT", target_of(log), token, log);
    }

    /// Asks until the answer has a status.
    bool await(std::string_view target, std::string_view token, int status) const {
        for (const auto end = Clock::now() + patience; Clock::now() < end;) {
            if (ask("GET", target, token).status == status) {
                return true;
            }
            std::this_thread::sleep_for(200ms); // wrong tokens are counted
        }
        return false;
    }

    void work() const {
        const auto worker = run_macadam(worker_words());
        EXPECT_EQ(worker.exit_status, 0) << worker.err;
    }

    std::string state(std::string_view log, std::string_view token) const {
        return nlohmann::json::parse(ask("GET", target_of(log), token).body)
            .at("state")
            .get<std::string>();
    }

    std::uint16_t port = quiet_port();
    std::string office = token("office", "operator");
    std::unique_ptr<PipedProgram> server;
};

TEST(ServerUpload, IsImportedByAWorkerAndTakenOutAgain) {
    const UploadWorld world;
    world.work(); // on what was submitted
    const auto before = world.digest();
    const auto log = world.log(0);
    const auto first = world.put(log, world.office);
    EXPECT_EQ(first.status, 202) << first.body;
    EXPECT_EQ(first.headers.at("location"), target_of(log));
    EXPECT_EQ(files_below(world.objects), 1U);
    EXPECT_EQ(world.put(log, world.office).status, 200); // known
    EXPECT_EQ(world.state(log, world.office), "queued");
    world.work();
    const auto fate = nlohmann::json::parse(world.ask("GET", target_of(log), world.office).body);
    EXPECT_EQ(fate.at("state"), "imported");
    EXPECT_EQ(fate.at("trips"), 1);
    EXPECT_GT(fate.at("passes"), 10);
    EXPECT_EQ(files_below(world.objects), 0U);
    EXPECT_NE(world.digest(), before);

    EXPECT_EQ(world.ask("DELETE", target_of(log), world.office).status, 202);
    EXPECT_EQ(world.state(log, world.office), "deleting");
    world.work();
    EXPECT_EQ(world.ask("GET", target_of(log), world.office).status, 404);
    EXPECT_EQ(world.digest(), before);
}

TEST(ServerUpload, IsTakenOnlyWithItsHashAndAToken) {
    const UploadWorld world;
    const auto log = world.log(0);
    EXPECT_EQ(world.ask("PUT", target_of("another log"), world.office, log).status, 422);
    EXPECT_EQ(world.put(log, "").status, 401);
    EXPECT_EQ(world.put(log, "mac_00000000_" + std::string(64, '0')).status, 401);
    const auto reader = world.token("reader", "read");
    ASSERT_TRUE(world.await("/v1/trips", reader, 403));
    EXPECT_EQ(world.put(log, reader).status, 403);
    EXPECT_EQ(files_below(world.objects), 1U); // that was submitted
    EXPECT_EQ(world.ask("GET", target_of(log), world.office).status, 404);
}

TEST(ServerUpload, IsRefusedWithWordsWhereNoObjectStoreIsKnown) {
    const UploadWorld world{false};
    const auto answer = world.put(world.log(0), world.office);
    EXPECT_EQ(answer.status, 503);
    EXPECT_THAT(answer.body, HasSubstr("macadam submit --objects"));
}

TEST(ServerUpload, IsSeenAndDeletedByItsSenderAlone) {
    UploadWorld world;
    const auto anna = world.token("anna", "operator"), ben = world.token("ben", "upload");
    ASSERT_TRUE(world.await("/v1/trips", ben, 200));
    const auto log = world.log(0);
    EXPECT_EQ(world.put(log, ben).status, 403); // not a crowd's
    ASSERT_EQ(world.put(log, anna).status, 202);
    EXPECT_EQ(world.ask("GET", target_of(log), ben).status, 404);
    EXPECT_EQ(world.ask("DELETE", target_of(log), ben).status, 404);
    EXPECT_THAT(world.ask("GET", "/v1/trips", ben).body, Not(HasSubstr(sha256_of(log))));
    EXPECT_THAT(world.ask("GET", "/v1/trips", anna).body, HasSubstr(sha256_of(log)));
    EXPECT_EQ(world.ask("DELETE", target_of(log), anna).status, 204); // nobody has begun it
    EXPECT_EQ(files_below(world.objects), 1U);
    EXPECT_EQ(run_macadam({"token", "revoke", world.address, "ben"}).exit_status, 0);
    EXPECT_TRUE(world.await("/v1/trips", ben, 401));
}

TEST(ServerUpload, IsLostByNoKillAfterItsAnswer) {
    UploadWorld world;
    for (int i = 0; i < 2; ++i) {
        ASSERT_EQ(world.put(world.log(i), world.office).status, 202);
        world.server->signal(SIGKILL);
        world.server->wait();
        world.start();
    }
    world.work();
    expect_all_imported(world, 3);
}

TEST(ServerUpload, IsSeenInTheQueueByOperatorsAlone) {
    const UploadWorld world;
    ASSERT_EQ(world.put(world.log(0), world.office).status, 202);
    const auto ben = world.token("ben", "upload");
    ASSERT_TRUE(world.await("/v1/trips", ben, 200));
    EXPECT_EQ(world.ask("GET", "/queue/status", ben).status, 403);
    EXPECT_EQ(world.ask("GET", "/queue/status", "").status, 401);
    std::string status; // read at most every 5 s
    for (const auto end = Clock::now() + patience;
         Clock::now() < end && status.find("\"queued\":2") == std::string::npos;) {
        std::this_thread::sleep_for(100ms);
        status = world.ask("GET", "/queue/status", world.office).body;
    }
    EXPECT_THAT(status, AllOf(HasSubstr("\"queued\":2"), HasSubstr("\"accepted_in_hour\":2")));
    const auto metrics = get(world.port, "/metrics").body;
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
        without = get(world.port, "/metrics").body;
    }
    EXPECT_THAT(without,
                AllOf(HasSubstr("macadam_http_requests_total"),
                      HasSubstr("macadam_queue_up 0\n"),
                      Not(HasSubstr("macadam_queue_logs"))));
    database.run("ALTER TABLE macadam.gone RENAME TO worker");
}

} // namespace
} // namespace macadam::testing
