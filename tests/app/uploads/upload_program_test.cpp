// Real servers and workers, also killed ones.

#include "storage/files/sha256.hpp"
#include "support/http/http_client.hpp"
#include "support/program/piped_program.hpp"
#include "support/program/program.hpp"
#include "support/roads/drive.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <memory>
#include <random>
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
using Clock = std::chrono::steady_clock;

std::string log_named(const std::string& trip_id) {
    const Drive drive{.length_m = 600, .trip_id = trip_id};
    return text_of(drive_over(patched_road([](double) { return false; }, 1),
                              drive,
                              *built_in_vehicle("golden-car")),
                   drive);
}

std::string sha256_of(std::string_view bytes) {
    Sha256 hash;
    hash.add(bytes);
    return hash.hex();
}

/// Database of one road, with a token of its operator.
struct World {
    fs::path folder = fresh_folder();
    std::string store = (folder / "roads.gpkg").string();
    std::uint16_t port = quiet_port();
    std::string token = made();

    std::string made() const {
        write_file(folder / "road.trip.csv", log_named("road"));
        EXPECT_EQ(run_macadam({"init", store, "--trace", (folder / "road.trip.csv").string()})
                      .exit_status,
                  0);
        auto text =
            run_macadam({"token", "create", store, "office", "--scope", "operator", "--quiet"}).out;
        text.erase(text.find_last_not_of('\n') + 1);
        return text;
    }

    std::vector<std::string> serve_words(const std::string& workers = "1") const {
        return {"serve",
                store,
                "--listen",
                fmt::format("127.0.0.1:{}", port),
                "--workers",
                workers,
                "--method",
                "kf",
                "--quiet"};
    }

    Answer ask(std::string_view method, std::string_view target, std::string_view body = {}) const {
        HttpClient client{port};
        client.send(fmt::format("{} {} HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer {}\r\n"
                                "Content-Type: text/csv\r\n{}\r\n{}",
                                method,
                                target,
                                token,
                                body.empty() ? std::string{}
                                             : fmt::format("Content-Length: {}\r\n", body.size()),
                                body));
        return client.answer();
    }

    Answer put(std::string_view log) const {
        return ask("PUT", "/v1/trips/" + sha256_of(log), log);
    }

    /// Waits until the server answers.
    bool is_up() const {
        for (const auto end = Clock::now() + 60s; Clock::now() < end;) {
            if (ask("GET", "/health").status == 200) {
                return true;
            }
            std::this_thread::sleep_for(10ms);
        }
        return false;
    }

    /// Waits until nothing is queued or worked on. \returns the states of all uploads.
    std::vector<std::string> fates() const {
        for (const auto end = Clock::now() + 90s; Clock::now() < end;) {
            const auto answer = ask("GET", "/v1/trips");
            std::vector<std::string> states;
            if (answer.status == 200) {
                const auto page = nlohmann::json::parse(answer.body);
                for (const auto& trip : page.at("trips")) {
                    states.push_back(trip.at("state").get<std::string>());
                }
                const bool waits = std::ranges::any_of(states, [](const auto& state) {
                    return state == "queued" || state == "working" || state == "deleting";
                });
                if (!waits) {
                    return states;
                }
            }
            std::this_thread::sleep_for(50ms);
        }
        return {"late"};
    }

    std::vector<fs::path> spooled() const {
        return {fs::directory_iterator{store + ".uploads/spool"}, fs::directory_iterator{}};
    }

    std::string digest() const { return run_macadam({"info", store, "--digest"}).out; }
};

/// Digest of a database into which the logs were imported.
std::string digest_of_import(const World& world, const std::vector<std::string>& logs) {
    const auto other = (world.folder / "other.gpkg").string();
    EXPECT_EQ(run_macadam({"init", other, "--trace", (world.folder / "road.trip.csv").string()})
                  .exit_status,
              0);
    fs::create_directories(world.folder / "logs");
    for (std::size_t i = 0; i < logs.size(); ++i) {
        write_file(world.folder / "logs" / fmt::format("{}.trip.csv", i), logs[i]);
    }
    EXPECT_EQ(run_macadam({"import", other, (world.folder / "logs").string(), "--method", "kf"})
                  .exit_status,
              0);
    return run_macadam({"info", other, "--digest"}).out;
}

TEST(Upload, BecomesPassesAsByImport) {
    const World world;
    const auto log = log_named("a");
    PipedProgram server{world.serve_words()};
    ASSERT_TRUE(world.is_up());
    EXPECT_EQ(world.put(log).status, 202);
    EXPECT_EQ(world.fates(), std::vector<std::string>{"imported"});
    const auto fate = nlohmann::json::parse(world.ask("GET", "/v1/trips/" + sha256_of(log)).body);
    EXPECT_GT(fate.at("passes"), 10);
    EXPECT_EQ(fate.at("trips"), 1);
    EXPECT_EQ(world.digest(), digest_of_import(world, {log}));
    EXPECT_THAT(world.spooled(), IsEmpty());
    server.signal(SIGTERM);
    const auto end = server.wait();
    EXPECT_EQ(end.exit_status, 0) << end.err;
}

TEST(Upload, IsRefusedInTheWordsOfImport) {
    const World world;
    PipedProgram server{world.serve_words()};
    ASSERT_TRUE(world.is_up());
    const std::string junk = "# macadam-trip 1\nt_s,lat_deg\n";
    EXPECT_EQ(world.put(junk).status, 202);
    EXPECT_EQ(world.fates(), std::vector<std::string>{"refused"});
    const auto fate = nlohmann::json::parse(world.ask("GET", "/v1/trips/" + sha256_of(junk)).body);
    write_file(world.folder / "log.csv", junk);
    const auto import = run_macadam({"import", world.store, (world.folder / "log.csv").string()});
    const auto reason = fate.at("reason").get<std::string>();
    EXPECT_THAT(reason, HasSubstr("log.csv"));
    EXPECT_THAT(import.out, HasSubstr(reason)); // but for the folder, which is the server's matter
    EXPECT_THAT(world.spooled(), IsEmpty());
}

TEST(Upload, IsTakenOutAgain) {
    const World world;
    const auto before = world.digest();
    const auto log = log_named("a");
    PipedProgram server{world.serve_words()};
    ASSERT_TRUE(world.is_up());
    world.put(log);
    ASSERT_EQ(world.fates(), std::vector<std::string>{"imported"});
    EXPECT_NE(world.digest(), before);
    EXPECT_EQ(world.ask("DELETE", "/v1/trips/" + sha256_of(log)).status, 202);
    EXPECT_THAT(world.fates(), IsEmpty());
    EXPECT_EQ(world.digest(), before);
    EXPECT_EQ(world.put(log).status, 202); // 'forget' keeps it out
    EXPECT_EQ(world.fates(), std::vector<std::string>{"known"});
    EXPECT_EQ(world.digest(), before);
}

TEST(Upload, WaitsForAWorkerOfItsOwn) {
    const World world;
    const auto log = log_named("a");
    PipedProgram server{world.serve_words("0")};
    ASSERT_TRUE(world.is_up());
    EXPECT_EQ(world.put(log).status, 202);
    const auto run = run_macadam({"worker", world.store, "--once", "--method", "kf", "--json"});
    EXPECT_EQ(run.exit_status, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("\"result\":\"imported\""));
    EXPECT_EQ(world.fates(), std::vector<std::string>{"imported"});
}

TEST(Server, ShowsNoFolderThatItCannotClose) {
    const auto run = run_macadam(
        {"serve", fresh_folder().string(), "--only-with-token", "--listen", "127.0.0.1:0"});
    EXPECT_EQ(run.exit_status, 2);
    EXPECT_THAT(run.err, HasSubstr("--only-with-token is for a database"));
}

TEST(Server, LeavesTheLookOfAFolderAsItWasExported) {
    for (const std::vector<std::string>& look :
         {std::vector<std::string>{"--title", "Our roads"}, {"--left-hand"}}) {
        std::vector<std::string> words{"serve", fresh_folder().string(), "--listen", "127.0.0.1:0"};
        words.insert(words.end(), look.begin(), look.end());
        const auto run = run_macadam(words);
        EXPECT_EQ(run.exit_status, 2);
        EXPECT_THAT(run.err, HasSubstr(look.front() + " is for a database"));
    }
}

TEST(Server, BelievesANameOfStaffOnAUnixSocketAlone) {
    const World world;
    const auto refusal = [&](const std::string& listen, const std::string& header) {
        const auto run =
            run_macadam({"serve", world.store, "--listen", listen, "--staff-header", header});
        EXPECT_EQ(run.exit_status, 2);
        return run.err;
    };
    EXPECT_THAT(refusal("127.0.0.1:0", "X-Forwarded-User"),
                HasSubstr("--staff-header is believed on a Unix socket only, expected --listen "
                          "unix:FILE"));
    EXPECT_THAT(refusal("unix:/tmp/macadam", "Authorization"),
                HasSubstr("expected the name of a header that the proxy sets"));
    EXPECT_THAT(refusal("unix:", "X-Forwarded-User"), HasSubstr("--listen is 'unix:'"));
}

TEST(Server, RefusesSectionsThatItCannotCut) {
    const World world;
    const auto refused = [&](const std::string& served, const std::string& table) {
        write_file(world.folder / "sections.csv", table);
        return run_macadam({"serve",
                            served,
                            "--sections",
                            (world.folder / "sections.csv").string(),
                            "--listen",
                            "127.0.0.1:0"});
    };
    const auto unknown = refused(world.store, "way_id,from_m,to_m\n99,0,20\n");
    EXPECT_EQ(unknown.exit_status, 1);
    EXPECT_THAT(unknown.err, HasSubstr("sections.csv:2: the network has no way '99'"));
    EXPECT_EQ(refused(world.store, "way,from\n1,0\n").exit_status, 1);
    const auto folder = refused(fresh_folder().string(), "way_id\n1\n");
    EXPECT_EQ(folder.exit_status, 2);
    EXPECT_THAT(folder.err, HasSubstr("--sections is for a database"));
}

TEST(Upload, IsForgottenAlsoWhileItWaits) {
    const World world;
    const auto before = world.digest();
    PipedProgram server{world.serve_words("0")};
    ASSERT_TRUE(world.is_up());
    EXPECT_EQ(world.put(log_named("a")).status, 202);
    const auto run = run_macadam({"forget", world.store, "--trip", "a"});
    EXPECT_EQ(run.exit_status, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr("importing the trips that a server has received, first"));
    EXPECT_THAT(world.spooled(), IsEmpty());
    EXPECT_THAT(world.fates(), IsEmpty()); // nor is it known who sent it
    EXPECT_EQ(world.digest(), before);
}

/// A few kills in each run of the tests, more in the long one.
int kills() {
    return std::getenv("MACADAM_TEST_ALL") != nullptr ? 50 : 24;
}

TEST(Upload, IsNeverLostNorCountedTwiceByKilledServers) {
    const World world;
    std::vector<std::string> logs;
    for (int i = 0; i < 8; ++i) {
        logs.push_back(log_named(fmt::format("trip {}", i)));
    }
    std::mt19937 random{7};
    auto server = std::make_unique<PipedProgram>(world.serve_words());
    ASSERT_TRUE(world.is_up());
    // Kills come while a log is sent, while it is imported, and right after it was acknowledged.
    std::jthread nemesis{[&] {
        for (int i = 0; i < kills(); ++i) {
            std::this_thread::sleep_for(std::chrono::milliseconds{random() % 600});
            server->signal(SIGKILL);
            server->wait();
            server = std::make_unique<PipedProgram>(world.serve_words());
            EXPECT_TRUE(world.is_up());
        }
    }};
    std::size_t acknowledged = 0;
    std::size_t sent = 0;
    for (const auto end = Clock::now() + 90s; acknowledged < logs.size() && Clock::now() < end;) {
        ++sent;
        const auto status = world.put(logs[acknowledged]).status;
        acknowledged += status == 202 || status == 200 ? 1 : 0;
        std::this_thread::sleep_for(status == 202 ? 1000ms : 20ms);
    }
    nemesis.join();
    EXPECT_EQ(acknowledged, logs.size());
    EXPECT_EQ(world.fates(), std::vector<std::string>(logs.size(), "imported")) << sent;
    EXPECT_EQ(world.digest(), digest_of_import(world, logs));
    EXPECT_THAT(world.spooled(), IsEmpty());
}

} // namespace
} // namespace macadam::testing
