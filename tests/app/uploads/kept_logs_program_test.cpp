// Logs that a real server keeps encrypted, from `init --keep-logs` to their end.

#include "storage/files/sha256.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "support/files/compressed.hpp"
#include "support/http/http_client.hpp"
#include "support/program/piped_program.hpp"
#include "support/program/program.hpp"
#include "support/roads/drive.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <filesystem>
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
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;
using Clock = std::chrono::steady_clock;

const Drive road{.length_m = 900};

/// Log of a trip that its recorder trimmed.
std::string log_of(const std::string& car) {
    auto drive = road;
    drive.trip_id = drive.vehicle_id = car;
    auto text = text_of(drive_over(patched_road([](double) { return false; }, 1),
                                   drive,
                                   *built_in_vehicle("golden-car")),
                        drive);
    text.insert(text.find('\n') + 1, "# trimmed_m: 300\n");
    return text;
}

std::string sha256_of(std::string_view bytes) {
    Sha256 hash;
    hash.add(bytes);
    return hash.hex();
}

/// Database of a crowd whose server keeps logs for 30 days.
class KeptLogs : public ::testing::Test {
protected:
    void SetUp() override {
        std::string osm{"<osm version=\"0.6\">"};
        for (int i = 0; i < 2; ++i) {
            const auto place = place_of(road, i * road.length_m);
            osm += fmt::format(R"(<node id="{}" lat="{:.7f}" lon="{:.7f}"/>)",
                               i + 1,
                               place.lat_deg,
                               place.lon_deg);
        }
        osm +=
            R"(<way id="1"><nd ref="1"/><nd ref="2"/><tag k="highway" v="primary"/></way></osm>)";
        write_file(folder_ / "road.osm", osm);
        run({"init",
             store_,
             "--network",
             at("road.osm"),
             "--privacy",
             "crowd",
             "--keep-logs",
             "30",
             "--logs-key",
             at("logs.key")});
        fs::create_directories(folder_ / "away");
        fs::rename(at("logs.key"), at("away/logs.key")); // the server needs no secret
        token_ = run({"token", "create", store_, "anna", "--quiet"}).out;
        token_.erase(token_.find_last_not_of('\n') + 1);
    }

    std::string at(const std::string& name) const { return (folder_ / name).string(); }

    static macadam::testing::Run run(const std::vector<std::string>& words, int expected = 0) {
        auto done = run_macadam(words);
        EXPECT_EQ(done.exit_status, expected) << words.front() << ": " << done.out << done.err;
        return done;
    }

    macadam::testing::Run reprocess(const std::string& key, int expected = 0) const {
        return run({"reprocess", store_, "--logs-key", at(key), "--method", "kf"}, expected);
    }

    std::vector<std::string> serve_words() const {
        return {"serve",
                store_,
                "--listen",
                fmt::format("127.0.0.1:{}", port_),
                "--method",
                "kf",
                "--vehicles",
                at("away"),
                "--quiet"};
    }

    Answer ask(std::string_view method,
               std::string_view target,
               std::string_view body = {},
               std::string_view type = "text/csv") const {
        HttpClient client{port_};
        client.send(fmt::format("{} {} HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer {}\r\n"
                                "Content-Type: {}\r\n{}\r\n{}",
                                method,
                                target,
                                token_,
                                type,
                                body.empty() ? std::string{}
                                             : fmt::format("Content-Length: {}\r\n", body.size()),
                                body));
        return client.answer();
    }

    /// Waits for an answer whose body has words, or the opposite. \returns the last one.
    Answer answer_with(const std::string& target, std::string_view words, bool has = true) const {
        Answer answer;
        for (const auto end = Clock::now() + 60s; Clock::now() < end;) {
            answer = ask("GET", target);
            if (answer.status != 0 && (answer.body.find(words) != std::string::npos) == has) {
                break;
            }
            std::this_thread::sleep_for(20ms);
        }
        return answer;
    }

    /// Sends logs to a server, and waits until they are imported.
    void send(const std::vector<std::string>& logs, std::string_view type = "text/csv") const {
        const PipedProgram server{serve_words()};
        answer_with("/health", "pass");
        for (const auto& log : logs) {
            const auto target = "/v1/trips/" + sha256_of(log);
            EXPECT_EQ(ask("PUT", target, log, type).status, 202);
            EXPECT_THAT(answer_with(target, "\"imported\"").body, HasSubstr("\"imported\""));
        }
    }

    std::vector<std::string> kept() const {
        std::vector<std::string> names;
        if (fs::exists(store_ + ".uploads/kept")) {
            for (const auto& file : fs::directory_iterator{store_ + ".uploads/kept"}) {
                names.push_back(file.path().filename());
            }
        }
        std::ranges::sort(names);
        return names;
    }

    static std::string kept_name(const std::string& log) { return sha256_of(log) + ".csv.sealed"; }

    std::string digest() const { return run({"info", store_, "--digest"}).out; }

    fs::path folder_ = fresh_folder();
    std::string store_ = at("crowd.gpkg");
    std::uint16_t port_ = quiet_port();
    std::string token_;
};

TEST_F(KeptLogs, AreReprocessedByWhoHasTheKeyToTheSameDigest) {
    const auto log = log_of("car-1");
    send({log});
    EXPECT_EQ(kept(), std::vector<std::string>{kept_name(log)});
    const auto line = log.substr(log.find("\n", log.size() / 2) + 1, 40);
    std::size_t files = 0;
    for (const auto& file : fs::recursive_directory_iterator{folder_}) {
        if (file.is_regular_file()) {
            ++files;
            EXPECT_EQ(read_file(file.path()).find(line), std::string::npos) << file.path();
        }
    }
    EXPECT_GE(files, 5U); // database, keys, list of uploads, kept log
    const auto before = digest();
    const auto done = reprocess("away/logs.key");
    EXPECT_THAT(done.err, Not(HasSubstr("can read this key")));
    EXPECT_THAT(done.out, AllOf(HasSubstr(sha256_of(log) + ".csv"), Not(HasSubstr("part-"))));
    EXPECT_THAT(done.err, HasSubstr("generation 2: 1 trip reprocessed, 0 unchanged"));
    EXPECT_EQ(digest(), before);
    EXPECT_EQ(kept(), std::vector<std::string>{kept_name(log)});
    for (const auto& file : fs::recursive_directory_iterator{folder_}) { // not even a link is left
        EXPECT_THAT(file.path().string(), Not(HasSubstr("open.part-")));
    }
    EXPECT_THAT(run({"info", store_}).out, HasSubstr("logs        kept encrypted for 30 days"));
}

TEST_F(KeptLogs, HaveAKeyForOneUserAlone) {
    const auto open_to = [&] { return fs::status(at("away/logs.key")).permissions(); };
    EXPECT_EQ(open_to(), fs::perms::owner_read | fs::perms::owner_write);
    fs::permissions(at("away/logs.key"), fs::perms::group_read, fs::perm_options::add);
    send({log_of("car-1")});
    EXPECT_THAT(reprocess("away/logs.key").err,
                HasSubstr("away/logs.key: other users can read this key, and with it the logs"));
    EXPECT_THAT(run({"init",
                     at("b.gpkg"),
                     "--network",
                     at("road.osm"),
                     "--privacy",
                     "crowd",
                     "--keep-logs",
                     "1",
                     "--logs-key",
                     at("away/logs.key")})
                    .err,
                HasSubstr("other users can read this key"));
}

TEST_F(KeptLogs, AreOfNoUseWithoutTheirKey) {
    send({log_of("car-1")});
    run({"init",
         at("b.gpkg"),
         "--network",
         at("road.osm"),
         "--privacy",
         "crowd",
         "--keep-logs",
         "1",
         "--logs-key",
         at("b.key")});
    EXPECT_THAT(reprocess("b.key", 1).out, HasSubstr("was not sealed for this key"));
    EXPECT_THAT(reprocess("crowd.gpkg.key", 1).err,
                HasSubstr("crowd.gpkg.key: is not a key of logs"));
    EXPECT_THAT(run({"reprocess", at("b.gpkg"), "--logs-key", at("b.key")}, 1).err,
                HasSubstr("b.gpkg: has no logs of a server"));
    EXPECT_THAT(run({"reprocess", store_}, 2).err, HasSubstr("PATH is missing"));
}

TEST_F(KeptLogs, GoWhenTheirTimeIsOver) {
    send({log_of("car-1"), log_of("car-2")});
    EXPECT_THAT(kept(), SizeIs(2));
    const auto age = [&](const std::string& log, int days) {
        Database{store_ + ".uploads/uploads.db", Database::Access::write}
            .prepare("UPDATE upload SET received_ms = received_ms - ? WHERE sha256 = ?")
            .run(std::int64_t{days} * 86'400'000, sha256_of(log));
    };
    age(log_of("car-1"), 30);
    age(log_of("car-2"), 29);
    run({"worker", store_, "--once"});
    EXPECT_EQ(kept(), std::vector<std::string>{kept_name(log_of("car-2"))});
    age(log_of("car-2"), 1);
    EXPECT_THAT(reprocess("away/logs.key", 1).err, HasSubstr("keeps no log"));
    EXPECT_THAT(kept(), IsEmpty());
}

TEST_F(KeptLogs, GoWhenTheirTimeIsOverThoughNothingCanBeImported) {
    send({log_of("car-1")});
    EXPECT_THAT(kept(), SizeIs(1));
    const std::string other(64, 'a');
    write_file(store_ + ".uploads/spool/" + other + ".csv", "waits");
    Database{store_ + ".uploads/uploads.db", Database::Access::write}.run(
        fmt::format("UPDATE upload SET received_ms = received_ms - 30 * 86400000;"
                    "INSERT INTO upload (sha256, owner, suffix, bytes, received_ms, state)"
                    " VALUES ('{}', 'anna', '.csv', 5, 0, 'queued')",
                    other));
    write_file(folder_ / "away/broken.toml", "[vehicle");
    EXPECT_THAT(run({"worker", store_, "--once", "--vehicles", at("away")}, 1).err,
                HasSubstr("broken.toml"));
    EXPECT_THAT(kept(), IsEmpty());
}

TEST_F(KeptLogs, GoWithTheirTrips) {
    send({log_of("car-1"), log_of("car-2")});
    EXPECT_THAT(kept(), SizeIs(2));
    run({"forget", store_, "--vehicle-id", "car-1"});
    EXPECT_EQ(kept(), std::vector<std::string>{kept_name(log_of("car-2"))});
    const PipedProgram server{serve_words()};
    answer_with("/health", "pass");
    EXPECT_EQ(ask("DELETE", "/v1/trips/" + sha256_of(log_of("car-2"))).status, 202);
    answer_with("/v1/trips", "deleting", false);
    EXPECT_THAT(kept(), IsEmpty());
}

TEST_F(KeptLogs, AreKeptByServersThatAreKilled) {
    const std::vector<std::string> logs{log_of("car-1"), log_of("car-2"), log_of("car-3")};
    for (int kill = 0; kill < 8; ++kill) { // while the first is sent, worked out, encrypted, ...
        PipedProgram server{serve_words()};
        answer_with("/health", "pass");
        for (const auto& log : logs) {
            ask("PUT", "/v1/trips/" + sha256_of(log), log);
        }
        std::this_thread::sleep_for(40ms * kill);
        server.signal(SIGKILL);
        server.wait();
    }
    const PipedProgram server{serve_words()};
    answer_with("/health", "pass");
    std::vector<std::string> names;
    for (const auto& log : logs) {
        answer_with("/v1/trips/" + sha256_of(log), "\"imported\"");
        names.push_back(kept_name(log));
    }
    std::ranges::sort(names);
    EXPECT_EQ(kept(), names);
    EXPECT_TRUE(fs::is_empty(store_ + ".uploads/spool"));
    const auto before = digest();
    EXPECT_THAT(reprocess("away/logs.key").err, HasSubstr("3 trips reprocessed, 0 unchanged"));
    EXPECT_EQ(digest(), before);
}

TEST_F(KeptLogs, OfAnArchiveGoWithAnyOfItsTrips) {
    const auto archive =
        archive_of("zip", {{"a.trip.csv", log_of("car-1")}, {"b.trip.csv", log_of("car-2")}});
    send({archive}, "application/zip");
    EXPECT_EQ(kept(), std::vector<std::string>{sha256_of(archive) + ".zip.sealed"});
    const auto before = digest();
    EXPECT_THAT(reprocess("away/logs.key").err,
                HasSubstr("generation 2: 2 trips reprocessed, 0 unchanged"));
    EXPECT_EQ(digest(), before);
    run({"forget", store_, "--vehicle-id", "car-1"});
    EXPECT_THAT(kept(), IsEmpty());
}

TEST_F(KeptLogs, ThatCannotBeWrittenAreImportedAllTheSame) {
    write_file(store_ + ".uploads/kept", "in the way");
    send({log_of("car-1")});
    EXPECT_TRUE(fs::is_empty(store_ + ".uploads/spool"));
}

TEST_F(KeptLogs, AreNoneThatHoldMoreThanTheirTrips) {
    const auto archive =
        archive_of("zip", {{"a.trip.csv", log_of("car-1")}, {"b.trip.csv", "# macadam-trip 1\n"}});
    send({archive}, "application/zip"); // what is refused, nobody could ask to forget
    EXPECT_THAT(kept(), IsEmpty());
}

TEST(KeptLogsOf, NoDatabaseButACrowds) {
    const auto folder = fresh_folder();
    const auto key = (folder / "logs.key").string();
    const auto refusal = [&](std::vector<std::string> words) {
        words.insert(words.begin(), {"init", (folder / "a.gpkg").string(), "--network", "a.osm"});
        const auto run = run_macadam(words);
        EXPECT_EQ(run.exit_status, 2);
        EXPECT_FALSE(fs::exists(key));
        return run.err;
    };
    EXPECT_THAT(refusal({"--keep-logs", "30", "--logs-key", key}),
                HasSubstr("--keep-logs is for a new database with --privacy crowd"));
    EXPECT_THAT(refusal({"--privacy", "crowd", "--keep-logs", "30"}),
                HasSubstr("expected --keep-logs DAYS and --logs-key FILE together"));
    EXPECT_THAT(refusal({"--privacy", "crowd", "--keep-logs", "0", "--logs-key", key}),
                HasSubstr("--keep-logs is 0, expected 1 to 3650 days"));
    EXPECT_EQ(run_macadam({"init",
                           (folder / "a.gpkg").string(),
                           "--network",
                           "missing.osm",
                           "--privacy",
                           "crowd",
                           "--keep-logs",
                           "30",
                           "--logs-key",
                           key})
                  .exit_status,
              1);
    EXPECT_FALSE(fs::exists(key)); // nor a key without a database
}

} // namespace
} // namespace macadam::testing
