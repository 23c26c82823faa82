// Trips that are submitted to a database on a real server, and workers of it, also killed ones.

#include "app/jobs/worker_world.hpp"
#include "storage/files/sha256.hpp"
#include "storage/jobs/announced_logs.hpp"
#include "storage/objects/object_store.hpp"
#include "storage/postgres/idle_limit.hpp"
#include "storage/postgres/server_connection.hpp"
#include "support/program/piped_program.hpp"
#include "support/s3/s3_service.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::size_t files_below(const fs::path& folder) {
    std::size_t count = 0;
    for (const auto& each : fs::recursive_directory_iterator{folder}) {
        count += each.is_regular_file() ? 1U : 0U;
    }
    return count;
}

TEST(Workers, ImportWhatWasSubmittedAsImportDoes) {
    WorkerWorld world;
    world.make_trips(3);
    auto words = world.submit_words();
    words.back() = "--json";
    const auto first = run_macadam(words);
    EXPECT_EQ(first.exit_status, 0) << first.err;
    EXPECT_THAT(first.out, AllOf(HasSubstr("\"result\":\"new\""), Not(HasSubstr("known"))));
    EXPECT_THAT(first.err, HasSubstr("3 logs submitted, 0 again, 0 already known"));
    EXPECT_EQ(files_below(world.objects), 3U);
    const auto again = run_macadam(words);
    EXPECT_THAT(again.err, HasSubstr("0 logs submitted, 0 again, 3 already known"));

    const auto worker = run_macadam(world.worker_words());
    EXPECT_EQ(worker.exit_status, 0) << worker.err;
    const auto table = run_macadam({"status", world.address}); // within a minute of the last
    EXPECT_THAT(table.out,
                AllOf(HasSubstr("imported          3\n"),
                      HasSubstr("no worker"),
                      HasSubstr("oldest waits for 0 s; 3 finished in the last minute")));
    EXPECT_THAT(run_macadam({"status", world.address, "--format", "prometheus"}).out,
                AllOf(HasSubstr("macadam_queue_logs{state=\"imported\"} 3\n"),
                      HasSubstr("macadam_queue_workers 0\n")));
    expect_all_imported(world, 3);
    EXPECT_EQ(files_below(world.objects), 0U); // logs are personal data
    EXPECT_THAT(run_macadam(words).err, HasSubstr("3 already known"));
}

TEST(Workers, LeaveNoLogOfATripThatIsForgotten) {
    WorkerWorld world;
    world.make_trips(2);
    auto worker = world.worker_words();
    worker.emplace_back("--keep-logs");
    EXPECT_EQ(run_macadam(world.submit_words()).exit_status, 0);
    EXPECT_EQ(run_macadam(worker).exit_status, 0);
    ASSERT_EQ(files_below(world.objects), 2U);
    ServerConnection server{world.address};
    const auto trip = server.rows("SELECT min(sha256) FROM macadam.trip").at(0)[0].value_or("");
    const auto forgot = run_macadam({"forget", world.address, "--trip", trip});
    EXPECT_EQ(forgot.exit_status, 0) << forgot.err;
    EXPECT_THAT(forgot.err, HasSubstr("1 submitted log erased from "));
    EXPECT_EQ(files_below(world.objects), 1U);
    EXPECT_EQ(server.number("SELECT count(*) FROM macadam.job"), 1);
    EXPECT_EQ(server.number("SELECT count(*) FROM macadam.job_trip"), 1);
}

TEST(Workers, EraseALogThatWasStoredAndNotSubmittedForADay) {
    WorkerWorld world;
    world.make_trips(1);
    ASSERT_EQ(run_macadam(world.submit_words()).exit_status, 0);
    write_file(world.folder / "log", "of somebody");
    Sha256 hash;
    hash.add("of somebody");
    const Job lost{.sha256 = hash.hex(), .suffix = ".trip.csv", .bytes = 11};
    ServerConnection server{world.address};
    announce_logs(server, {&lost, 1});
    open_object_store(world.objects, {}, MissingFolder::refuse)
        ->put({lost.sha256, lost.bytes}, world.folder / "log");
    EXPECT_EQ(run_macadam(world.worker_words()).exit_status, 0);
    EXPECT_EQ(files_below(world.objects), 1U); // it may still be submitted
    server.run("UPDATE macadam.announced_log SET announced_at = now() - interval '25 hours'");
    EXPECT_EQ(run_macadam(world.worker_words()).exit_status, 0);
    EXPECT_EQ(files_below(world.objects), 0U);
}

TEST(Workers, TellWhyALogIsRefusedAndTryItAgainWhenItIsSubmittedAgain) {
    WorkerWorld world;
    write_file(world.trips / "junk.trip.csv", "# macadam-trip 1\nt_s,lat_deg\n");
    ASSERT_EQ(run_macadam(world.submit_words()).exit_status, 0);
    EXPECT_EQ(run_macadam(world.worker_words()).exit_status, 0);
    const auto status = nlohmann::json::parse(world.status());
    EXPECT_EQ(status.at("logs").at("refused"), 1);
    EXPECT_THAT(status.at("failed").at(0).at("reason").get<std::string>(),
                AllOf(HasSubstr("log.trip.csv"), Not(HasSubstr("/tmp"))));
    EXPECT_EQ(files_below(world.objects), 1U);
    EXPECT_THAT(run_macadam({"submit", world.address, world.trips.string()}).err,
                HasSubstr("0 logs submitted, 1 again, 0 already known"));
}

TEST(Workers, FetchLogsFromABucket) {
    WorkerWorld world;
    world.make_trips(2);
    const S3Service service{world.folder};
    world.objects = "s3://roads/logs";
    const auto submit = run_macadam(world.submit_words());
    EXPECT_EQ(submit.exit_status, 0) << submit.err;
    const auto worker = run_macadam(world.worker_words());
    EXPECT_EQ(worker.exit_status, 0) << worker.err;
    expect_all_imported(world, 2);
}

TEST(Workers, CountNoAttemptWhileABucketCannotBeReached) {
    WorkerWorld world;
    world.make_trips(2);
    world.objects = "s3://roads/logs";
    {
        const S3Service service{world.folder};
        ASSERT_EQ(run_macadam(world.submit_words()).exit_status, 0);
    }
    ServerConnection server{world.address};
    server.run("UPDATE macadam.job SET attempts = 4"); // another one would be the last
    const auto expect_waiting = [&] {
        EXPECT_EQ(server.number("SELECT count(*) FROM macadam.job WHERE state = 'queued'"
                                " AND attempts = 4"),
                  2);
    };
    const auto away = run_macadam(world.worker_words()); // nobody listens
    EXPECT_EQ(away.exit_status, 1);
    EXPECT_THAT(away.err,
                AllOf(HasSubstr("s3://roads/logs: cannot fetch an object: 127.0.0.1:"),
                      HasSubstr("its logs wait until it can be reached")));
    expect_waiting();
    {
        const S3Service refusing{world.folder, {"--failing", "1", "--status", "403"}};
        EXPECT_THAT(run_macadam(world.worker_words()).err, HasSubstr("answers 403"));
        expect_waiting();
    }
    const S3Service service{world.folder, {"--failing", "5"}};
    auto words = world.worker_words();
    std::erase(words, "--once");
    PipedProgram worker{words};
    const auto end = std::chrono::steady_clock::now() + 120s;
    while (server.number("SELECT count(*) FROM macadam.job WHERE state = 'imported'") < 2 &&
           std::chrono::steady_clock::now() < end) {
        std::this_thread::sleep_for(100ms);
    }
    worker.signal(SIGTERM);
    const auto done = worker.wait();
    EXPECT_EQ(done.exit_status, 0);
    EXPECT_THAT(done.err, HasSubstr("answers 503"));
    EXPECT_EQ(run_macadam(world.worker_words()).exit_status, 0); // fuses
    expect_all_imported(world, 2);
}

TEST(Workers, TakeNoDamagedLog) {
    WorkerWorld world;
    world.make_trips(1);
    ASSERT_EQ(run_macadam(world.submit_words()).exit_status, 0);
    for (const auto& each : fs::recursive_directory_iterator{world.objects}) {
        if (each.is_regular_file()) {
            auto log = read_file(each.path());
            log[log.size() / 2] ^= 1;
            write_file(each.path(), log);
        }
    }
    ServerConnection{world.address}.run("UPDATE macadam.job SET attempts = 4");
    const auto worker = run_macadam(world.worker_words());
    EXPECT_THAT(worker.err, HasSubstr("is damaged: its bytes have another SHA-256"));
    const auto status = nlohmann::json::parse(world.status());
    EXPECT_EQ(status.at("logs").at("parked"), 1);
    EXPECT_THAT(status.at("failed").at(0).at("reason").get<std::string>(), HasSubstr("is damaged"));
    const auto again = run_macadam({"submit", world.address, "--again"});
    EXPECT_EQ(again.exit_status, 0);
    EXPECT_THAT(again.err, HasSubstr("1 parked log submitted again"));
    EXPECT_EQ(nlohmann::json::parse(world.status()).at("logs").at("queued"), 1);
    EXPECT_EQ(run_macadam({"submit", world.address}).exit_status, 2);
    const auto both = run_macadam({"submit", world.address, world.trips.string(), "--again"});
    EXPECT_EQ(both.exit_status, 2);
    EXPECT_THAT(both.err, HasSubstr("expected no PATH"));
}

TEST(Workers, AreRefusedWithWords) {
    const WorkerWorld world;
    ServerConnection server{world.address};
    server.run("INSERT INTO macadam.work_setting VALUES ('results_version', '0')");
    const auto worker = run_macadam(world.worker_words());
    EXPECT_EQ(worker.exit_status, 1);
    EXPECT_THAT(worker.err,
                AllOf(HasSubstr("its workers compute results of version 0, this program those of "
                                "version"),
                      HasSubstr("values of both must not mix")));
    const auto road = (world.folder / "road.trip.csv").string();
    for (const auto* const command : {"import", "reprocess"}) {
        const auto beside = run_macadam({command, world.address, road, "--method", "kf"});
        EXPECT_EQ(beside.exit_status, 1) << command;
        EXPECT_THAT(beside.err, HasSubstr("its workers compute results of version 0")) << command;
    }
    EXPECT_EQ(server.number("SELECT count(*) FROM macadam.trip"), 0);
    const auto of_file =
        run_macadam({"worker", (world.folder / "roads.gpkg").string(), "--once", "--objects", "x"});
    EXPECT_EQ(of_file.exit_status, 2);
    EXPECT_THAT(of_file.err, HasSubstr("--objects is for a database on a server"));
    const auto nowhere = run_macadam({"submit", world.address, world.folder.string()});
    EXPECT_EQ(nowhere.exit_status, 2);
    EXPECT_THAT(nowhere.err, HasSubstr("--objects is missing"));
}

TEST(Workers, TakeLogsWhoseNamesAreNoText) {
    WorkerWorld world;
    world.make_trips(2);
    const auto file = world.trips / "00001.trip.csv";
    auto log = read_file(file);
    const auto name = log.find("trip 00001");
    ASSERT_NE(name, std::string::npos);
    log[name + 4] = '\xe9'; // Latin-1
    write_file(file, log);
    ASSERT_EQ(run_macadam(world.submit_words()).exit_status, 0);
    const auto worker = run_macadam(world.worker_words());
    EXPECT_EQ(worker.exit_status, 0) << worker.err;
    EXPECT_EQ(nlohmann::json::parse(world.status()).at("logs").at("imported"), 2);
    EXPECT_EQ(ServerConnection{world.address}.number("SELECT count(*) FROM macadam.trip"), 2);
}

TEST(Workers, GoOnWhereAllTheirConnectionsBroke) {
    WorkerWorld world;
    constexpr std::size_t trips = 20;
    world.make_trips(trips);
    ASSERT_EQ(run_macadam(world.submit_words()).exit_status, 0);
    auto words = world.worker_words();
    std::erase(words, "--once");
    words.back() = "--json";
    PipedProgram worker{words};
    EXPECT_TRUE(worker.line(60s).has_value()); // it works on the first batch
    ServerConnection server{world.address};
    server.run("SELECT pg_terminate_backend(pid) FROM pg_stat_activity"
               " WHERE pid <> pg_backend_pid() AND datname = current_database()");
    const auto count = [&](const std::string& what) {
        return server.number("SELECT count(*) FROM macadam." + what);
    };
    const auto end = std::chrono::steady_clock::now() + 120s;
    while ((count("job WHERE finished_at IS NULL") > 0 || count("chunk_dirty") > 0) &&
           std::chrono::steady_clock::now() < end) {
        std::this_thread::sleep_for(100ms);
    }
    worker.signal(SIGTERM);
    EXPECT_EQ(worker.wait().exit_status, 0);
    EXPECT_EQ(count("job WHERE attempts <> 1"), 0); // it was no fault of the logs
    expect_all_imported(world, trips);
}

TEST(Workers, ParkNoLogWhileTheirStatementsAreCancelled) {
    WorkerWorld world;
    world.make_trips(2);
    ASSERT_EQ(run_macadam(world.submit_words()).exit_status, 0);
    ServerConnection server{world.address};
    server.run("UPDATE macadam.job SET attempts = 4"); // another one would be the last
    ServerConnection holder{world.address};
    holder.begin(false);
    set_idle_limit(holder, "0");
    holder.run("LOCK TABLE macadam.trip IN SHARE MODE"); // each import waits
    auto words = world.worker_words();
    std::erase(words, "--once");
    PipedProgram worker{words};
    const auto unfinished = [&] {
        return server.number("SELECT count(*) FROM macadam.job WHERE finished_at IS NULL");
    };
    for (std::int64_t cancelled = 0; cancelled < 3 && unfinished() > 0;) {
        std::this_thread::sleep_for(100ms);
        cancelled += server.number("SELECT count(pg_cancel_backend(pid)) FROM pg_stat_activity"
                                   " WHERE wait_event_type = 'Lock'"
                                   " AND datname = current_database()");
    }
    holder.roll_back();
    while (unfinished() > 0) { // the test's time limit ends it
        std::this_thread::sleep_for(100ms);
    }
    worker.signal(SIGTERM);
    const auto done = worker.wait();
    EXPECT_EQ(done.exit_status, 0);
    EXPECT_THAT(done.err, HasSubstr("canceling statement due to user request"));
    EXPECT_EQ(server.number("SELECT count(*) FROM macadam.job WHERE state = 'imported'"
                            " AND attempts = 5"), // as if none had been cancelled
              2);
    EXPECT_EQ(run_macadam(world.worker_words()).exit_status, 0); // fuses
    expect_all_imported(world, 2);
}

TEST(Workers, GoOnBesideOneThatStandsStillWhileItFuses) {
    WorkerWorld world;
    world.make_trips(2);
    ASSERT_EQ(run_macadam(world.submit_words()).exit_status, 0);
    ServerConnection server{world.address};
    server.run("DO $$ BEGIN EXECUTE format('ALTER DATABASE %I SET"
               " idle_in_transaction_session_timeout = ''3s''', current_database()); END $$");
    ServerConnection holder{world.address};
    holder.begin(false);
    set_idle_limit(holder, "0");
    holder.run("LOCK TABLE macadam.chunk_change IN SHARE MODE"); // which fusion writes in the end
    auto words = world.worker_words();
    std::erase(words, "--once");
    PipedProgram frozen{words};
    while (server.number("SELECT count(*) FROM pg_stat_activity WHERE wait_event_type = 'Lock'"
                         " AND query LIKE '%chunk_change%'") == 0) {
        std::this_thread::sleep_for(50ms); // the test's time limit ends it
    }
    frozen.signal(SIGSTOP);
    holder.commit();

    world.make_trips(3);
    ASSERT_EQ(run_macadam(world.submit_words()).exit_status, 0);
    const auto other = run_macadam(world.worker_words());
    EXPECT_EQ(other.exit_status, 0) << other.err;
    expect_all_imported(world, 3);
    frozen.signal(SIGCONT);
    frozen.signal(SIGTERM);
    EXPECT_EQ(frozen.wait().exit_status, 0);
}

TEST(Workers, EndWithWordsOnceOthersTookOverMeanwhile) {
    WorkerWorld world;
    constexpr std::size_t trips = 30;
    world.make_trips(trips);
    ASSERT_EQ(run_macadam(world.submit_words()).exit_status, 0);
    auto words = world.worker_words();
    words.back() = "--json";
    PipedProgram worker{words};
    EXPECT_TRUE(worker.line(60s).has_value()); // it works
    ServerConnection server{world.address};
    server.run("UPDATE macadam.work_setting SET value = '99' WHERE key = 'results_version'");
    const auto ended = worker.wait();
    EXPECT_EQ(ended.exit_status, 1);
    EXPECT_THAT(ended.err, HasSubstr("its workers compute results of version 99"));
    EXPECT_EQ(server.number("SELECT count(*) FROM macadam.job WHERE state = 'queued'"
                            " AND attempts > 0"),
              0);
    words.back() = "--take-over";
    EXPECT_EQ(run_macadam(words).exit_status, 0);
    expect_all_imported(world, trips);
}

TEST(Workers, EndAtOnceAndGiveTheirLogsBack) {
    WorkerWorld world;
    world.make_trips(30);
    ASSERT_EQ(run_macadam(world.submit_words()).exit_status, 0);
    auto words = world.worker_words();
    words.back() = "--json";
    PipedProgram worker{words};
    EXPECT_TRUE(worker.line(60s).has_value()); // it works
    worker.signal(SIGTERM);
    EXPECT_EQ(worker.wait().exit_status, 0);
    const auto status = nlohmann::json::parse(world.status());
    EXPECT_EQ(status.at("logs").at("working"), 0);
    EXPECT_EQ(ServerConnection{world.address}.number("SELECT max(attempts) FROM macadam.job"), 1);
    EXPECT_EQ(run_macadam(world.worker_words()).exit_status, 0);
    expect_all_imported(world, 30);
}

// 300 kills over 3,000 trips: worker_kills.cpp.
TEST(Workers, LoseNoTripAndCountNoneTwiceWhenTheyAreKilled) {
    WorkerWorld world;
    constexpr std::size_t trips = 40;
    world.make_trips(trips);
    ASSERT_EQ(run_macadam(world.submit_words()).exit_status, 0);
    kill_workers(world, {.workers = 2, .kills = 10, .trips = trips});
    expect_all_imported(world, trips);
}

} // namespace
} // namespace macadam::testing
