#include "app/jobs/worker_world.hpp"

#include "storage/postgres/server_connection.hpp"
#include "support/program/piped_program.hpp"
#include "support/program/postgres_server.hpp"
#include "support/roads/drive.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <csignal>
#include <memory>
#include <random>
#include <thread>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;

std::string log_named(const std::string& trip_id) {
    const Drive drive{.length_m = 600, .trip_id = trip_id};
    return text_of(drive_over(patched_road([](double) { return false; }, 1),
                              drive,
                              *built_in_vehicle("golden-car")),
                   drive);
}

std::string new_address() {
    static PostgresServer server{std::chrono::seconds{1700}}; // as long as the longest test
    static int number = 0;
    return server.new_database(fmt::format("roads{}", ++number));
}

void expect_done(const std::vector<std::string>& words) {
    const auto run = run_macadam(words);
    ASSERT_EQ(run.exit_status, 0) << run.err;
}

} // namespace

WorkerWorld::WorkerWorld()
    : folder{fresh_folder()}, address{new_address()}, objects{(folder / "objects").string()},
      trips{folder / "trips"} {
    fs::create_directory(trips);
    write_file(folder / "road.trip.csv", log_named("road"));
    const auto file = (folder / "roads.gpkg").string();
    expect_done({"init", file, "--trace", (folder / "road.trip.csv").string()});
    expect_done({"copy", file, address});
}

void WorkerWorld::make_trips(std::size_t count) {
    const auto log = log_named("trip 00000");
    const auto at = log.find("00000");
    for (std::size_t i = 0; i < count; ++i) {
        auto other = log;
        other.replace(at, 5, fmt::format("{:05}", i));
        write_file(trips / fmt::format("{:05}.trip.csv", i), other);
    }
}

std::vector<std::string> WorkerWorld::submit_words() const {
    return {"submit", address, trips.string(), "--objects", objects, "--quiet"};
}

std::vector<std::string> WorkerWorld::worker_words() const {
    return {
        "worker", address, "--once", "--method", "kf", "--jobs", "1", "--lease", "2", "--quiet"};
}

std::string WorkerWorld::digest() const {
    return run_macadam({"info", address, "--digest"}).out;
}

std::string WorkerWorld::digest_of_import() const {
    const auto file = (folder / "roads.gpkg").string();
    const auto run = run_macadam({"import", file, trips.string(), "--method", "kf", "--quiet"});
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return run_macadam({"info", file, "--digest"}).out;
}

std::string WorkerWorld::status() const {
    const auto run = run_macadam({"status", address, "--json"});
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return run.out;
}

void kill_workers(const WorkerWorld& world, const KillPlan& plan) {
    std::mt19937 random{11};
    const auto start = [&] { return std::make_unique<PipedProgram>(world.worker_words()); };
    std::vector<std::unique_ptr<PipedProgram>> workers;
    for (std::size_t i = 0; i < plan.workers; ++i) {
        workers.push_back(start());
    }
    ServerConnection server{world.address};
    const auto finished = [&] {
        return static_cast<std::size_t>(
            server.number("SELECT count(*) FROM macadam.job WHERE state <> 'queued'"
                          " AND state <> 'working'"));
    };
    constexpr std::uint32_t longest_ms = 300;
    for (std::size_t kill = 0; kill < plan.kills; ++kill) {
        while (finished() * plan.kills < kill * plan.trips) {
            std::this_thread::sleep_for(std::chrono::milliseconds{5});
        }
        std::this_thread::sleep_for(std::chrono::milliseconds{random() % longest_ms});
        auto& victim = workers[random() % workers.size()];
        victim->signal(SIGKILL);
        victim->wait();
        victim = start();
    }
    for (const auto& worker : workers) {
        const auto end = worker->wait();
        EXPECT_EQ(end.exit_status, 0) << end.err;
    }
}

void expect_all_imported(const WorkerWorld& world, std::size_t count) {
    const auto logs = nlohmann::json::parse(world.status()).at("logs");
    EXPECT_EQ(logs.at("imported").get<std::size_t>() + logs.at("known").get<std::size_t>(), count)
        << logs;
    ServerConnection server{world.address};
    EXPECT_EQ(static_cast<std::size_t>(server.number("SELECT count(*) FROM macadam.trip")), count);
    EXPECT_EQ(server.number("SELECT count(*) FROM macadam.chunk_dirty"), 0);
    EXPECT_EQ(world.digest(), world.digest_of_import());
}

} // namespace macadam::testing
