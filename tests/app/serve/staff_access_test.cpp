// Staff whom a proxy has logged in, as clients of a Unix socket and of TCP see it.

#include "app/cli/console.hpp"
#include "app/http/listening_socket.hpp"
#include "app/serve/api_server.hpp"
#include "app/site/site_page.hpp"
#include "storage/files/sha256.hpp"
#include "support/files/files.hpp"
#include "support/http/http_client.hpp"
#include "support/roads/store_world.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <future>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>

#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// File name that is short enough for a socket.
fs::path socket_file(std::string_view name) {
    auto file = fs::temp_directory_path() / fmt::format("macadam-{}-{}", ::getpid(), name);
    fs::remove(file);
    return file;
}

std::string sha256_of(std::string_view bytes) {
    Sha256 hash;
    hash.add(bytes);
    return hash.hex();
}

/// Server of a database of own cars, without a token.
struct StaffWorld {
    explicit StaffWorld(HttpServerConfig config, const std::string& header)
        : file{new_file()}, server{[this, config, header] {
              serve_database(file,
                             Audience::anyone,
                             config,
                             {},
                             Console{Verbosity::quiet, stop.get_token()},
                             [this](std::uint16_t its_port) { started.set_value(its_port); },
                             {.workers = 0, .staff_header = header, .only_with_token = true});
          }} {}
    ~StaffWorld() { stop.request_stop(); }
    StaffWorld(const StaffWorld&) = delete;
    StaffWorld& operator=(const StaffWorld&) = delete;

    static fs::path new_file() {
        auto path = test_folder() / "roads.gpkg";
        RoadStore::create(path, small_country(), settings());
        return path;
    }

    fs::path file;
    std::stop_source stop;
    std::promise<std::uint16_t> started;
    std::jthread server;
    std::uint16_t port = started.get_future().get();
};

Answer ask(HttpClient&& client,
           std::string_view target,
           std::string_view headers,
           std::string_view method = "GET",
           std::string_view body = {}) {
    client.send(fmt::format("{} {} HTTP/1.1\r\nHost: localhost\r\n{}\r\n{}",
                            method,
                            target,
                            body.empty() ? std::string{headers}
                                         : fmt::format("{}Content-Length: {}\r\n"
                                                       "Content-Type: text/csv\r\n",
                                                       headers,
                                                       body.size()),
                            body));
    return client.answer();
}

constexpr std::string_view carla = "X-Forwarded-User: carla\r\n";

TEST(StaffAccess, IsThatOfAnOperatorOnAUnixSocket) {
    const auto socket = socket_file("web");
    {
        const StaffWorld world{{.unix_socket = socket}, "x-forwarded-user"};
        const auto status = [&](std::string_view target, std::string_view headers) {
            return ask(HttpClient{socket}, target, headers).status;
        };
        for (const auto* const target : {"/v1/trips", "/collections/trips/items", "/conformance"}) {
            EXPECT_EQ(status(target, carla), 200) << target;
            EXPECT_EQ(status(target, ""), 401) << target;
            EXPECT_EQ(status(target, "X-Forwarded-User: \r\n"), 401) << target;
            EXPECT_EQ(status(target, "X-Forwarded-User: eve\r\nX-Forwarded-User: carla\r\n"), 401)
                << target;
            EXPECT_EQ(status(target, "X_Forwarded_User: carla\r\n"), 401) << target;
            EXPECT_EQ(status(target, "X-Remote-User: carla\r\n"), 401) << target;
        }
        EXPECT_EQ(status("/queue/status", ""), 401);
        EXPECT_THAT(ask(HttpClient{socket}, "/queue/status", carla).body,
                    HasSubstr("a database in a file has no queue"));
        const std::string log = "a log";
        const auto target = "/v1/trips/" + sha256_of(log);
        EXPECT_EQ(ask(HttpClient{socket}, target, "", "PUT", log).status, 401);
        EXPECT_EQ(ask(HttpClient{socket}, target, carla, "PUT", log).status, 202);
        EXPECT_THAT(ask(HttpClient{socket}, "/v1/trips", carla).body, HasSubstr(sha256_of(log)));
        EXPECT_EQ(ask(HttpClient{socket}, target, carla, "DELETE").status, 204);
        const auto events = fmt::format("{}Accept: text/event-stream\r\n", carla);
        EXPECT_EQ(ask(HttpClient{socket}, target, carla, "PUT", log).status, 202);
        HttpClient follower{socket};
        follower.send(fmt::format("GET {} HTTP/1.1\r\nHost: localhost\r\n{}\r\n", target, events));
        EXPECT_THAT(follower.read_until("\"queued\""), HasSubstr("event: state"));
        struct stat found {};
        ASSERT_EQ(::stat(socket.c_str(), &found), 0);
        EXPECT_EQ(found.st_mode & 0777U, 0660U);
    }
    EXPECT_FALSE(fs::exists(fs::symlink_status(socket)));
}

TEST(StaffAccess, IsNobodysOverTcp) {
    const StaffWorld world{{.port = 0}, ""};
    for (const auto* const target : {"/v1/trips", "/collections/trips/items", "/conformance"}) {
        const auto answer = ask(HttpClient{world.port}, target, carla);
        EXPECT_TRUE(answer.status == 401 || answer.status == 404) << target << answer.status;
    }
}

TEST(OpenPages, LeadToTheRecorderBeforeTheFirstMap) {
    const StaffWorld world{{.port = 0}, ""}; // without trips
    EXPECT_EQ(ask(HttpClient{world.port}, "/driven", "").status, 401);
    if (!refusal_of([] { static_cast<void>(site_page_folder()); }).empty()) {
        return; // this build has no page
    }
    const auto moved = ask(HttpClient{world.port}, "/drive", "");
    ASSERT_EQ(moved.status, 308);
    EXPECT_EQ(moved.headers.at("location"), "drive/");
    EXPECT_EQ(ask(HttpClient{world.port}, "/drive/", "").status, 200);
}

TEST(UnixSocket, TakesThePlaceOfOneThatNobodyListensOn) {
    const auto file = socket_file("left");
    const int first = open_listening_socket(file);
    EXPECT_THAT(refusal_of([&] { open_listening_socket(file); }),
                HasSubstr("Address already in use; choose another with --listen"));
    ::close(first); // as after a kill: the file stays
    ASSERT_TRUE(fs::is_socket(file));
    const auto umask_before = ::umask(0077);
    const int second = open_listening_socket(file);
    ::umask(umask_before);
    struct stat found {};
    ASSERT_EQ(::stat(file.c_str(), &found), 0);
    EXPECT_EQ(found.st_mode & 0777U, 0660U);
    ::close(second);
    fs::remove(file);
}

TEST(UnixSocket, LeavesFilesOfOthersAlone) {
    const auto file = socket_file("other");
    std::ofstream{file} << "text";
    EXPECT_THAT(refusal_of([&] { open_listening_socket(file); }),
                HasSubstr("cannot listen on " + file.string()));
    EXPECT_EQ(fs::file_size(file), 4U);
    fs::remove(file);
    EXPECT_THAT(refusal_of([&] { open_listening_socket(fs::path{std::string(200, 'x')}); }),
                HasSubstr("is no name of a Unix socket, expected 1 to 107 bytes"));
}

} // namespace
} // namespace macadam::testing
