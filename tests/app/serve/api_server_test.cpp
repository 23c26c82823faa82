// The server as a whole: a flood of one client, a database that is away, its log, other sites.

#include "storage/uploads/upload_database.hpp"
#include "support/files/files.hpp"
#include "support/http/http_client.hpp"
#include "support/http/served_store.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <deque>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

void wait_until(const std::function<bool()>& is_so) {
    while (!is_so()) { // the test's time limit ends it
        std::this_thread::sleep_for(std::chrono::milliseconds{20});
    }
}

/// File whose readers wait until release().
class HangingFile {
public:
    explicit HangingFile(fs::path path, std::string_view content)
        : path_{std::move(path)}, pipe_{path_.string() + ".pipe"},
          whole_{written(path_.parent_path(), "whole", content)} {
        EXPECT_EQ(mkfifo(path_.c_str(), 0600), 0);
        fs::create_hard_link(path_, pipe_);
    }
    HangingFile(const HangingFile&) = delete;
    HangingFile& operator=(const HangingFile&) = delete;
    ~HangingFile() { release(); }

    /// Ends the pipe, and puts the content in its place.
    void release() const {
        if (fs::exists(whole_)) {
            fs::rename(whole_, path_);
            ::close(::open(pipe_.c_str(), O_RDWR | O_CLOEXEC));
        }
    }

private:
    fs::path path_, pipe_, whole_;
};

TEST(ApiServer, AnswersTilesAndPagesWhileOneClientFloodsItWithSelections) {
    const auto table = test_folder() / "sections.csv"; // its folder is that of the database
    const SectionOptions options{.route = {},
                                 .best = {},
                                 .along = {},
                                 .sections = table,
                                 .length_m = 100,
                                 .homogeneous = false,
                                 .exclude = {},
                                 .exclude_radius_m = 20};
    const ServedWorld served{{.port = 0, .workers = 1}, {}, options};
    const HangingFile sections{table, "section,way_id,from_m,to_m\nhigh,1,0,200\n"};
    wait_until([&] { return served.ask("/tiles.json").status == 200; });
    const auto tile_before = served.ask("/tiles/WebMercatorQuad/0/0/0").status;
    EXPECT_TRUE(tile_before == 200 || tile_before == 204) << tile_before; // 204: it is empty
    std::deque<HttpClient> flood;
    for (int i = 0; i < 9; ++i) { // one more than one client may
        flood.emplace_back(served.port)
            .send("GET /collections/sections/items HTTP/1.1\r\nHost: localhost\r\n\r\n");
    }
    wait_until(
        [&] { return served.ask("/metrics").body.find("code=\"429\"} 1") != std::string::npos; });
    EXPECT_EQ(served.ask("/tiles/WebMercatorQuad/0/0/0").status, tile_before);
    EXPECT_EQ(served.ask("/collections/segments/tiles/WebMercatorQuad/0/0/0").status, tile_before);
    EXPECT_EQ(served.ask("/?f=json").status, 200);
    EXPECT_EQ(served.ask("/health").status, 200);
    sections.release();
    int refused = 0;
    for (auto& client : flood) {
        const auto answer = client.answer();
        refused += answer.status == 429 && answer.headers.at("retry-after") == "1" ? 1 : 0;
    }
    EXPECT_EQ(refused, 1);
    EXPECT_EQ(served.ask("/collections/sections/items").status, 200); // there is room again
}

TEST(ApiServer, WarnsMonitorsWhileItCannotReadItsDatabase) {
    const ServedWorld served;
    const auto well = served.ask("/health");
    EXPECT_EQ(well.headers.at("content-type"), "application/health+json");
    EXPECT_EQ(nlohmann::json::parse(well.body), (nlohmann::json{{"status", "pass"}}));
    const auto away = served.file.parent_path() / "away.gpkg";
    fs::rename(served.file, away);
    const auto status = [&] {
        return nlohmann::json::parse(served.ask("/health").body).at("status");
    };
    wait_until([&] { return status() != "pass"; });
    const auto ill = served.ask("/health");
    EXPECT_EQ(ill.status, 200); // it answers
    EXPECT_EQ(nlohmann::json::parse(ill.body).at("status"), "warn");
    EXPECT_THAT(ill.body, HasSubstr("the database cannot be read now"));
    EXPECT_THAT(ill.body, Not(HasSubstr("roads.gpkg"))); // for its operator alone
    fs::rename(away, served.file);
    wait_until([&] { return status() == "pass"; });
}

TEST(ApiServer, LogsNothingThatTellsWhoAskedForWhichPlace) {
    ::testing::internal::CaptureStdout();
    const std::string hash(64, 'd');
    {
        const ServedWorld served{{.port = 0, .behind_proxy = true},
                                 {.base = {}, .has_access_log = true}};
        make_uploads_folder(served.file);
        const std::string_view headers = "Authorization: Bearer mac_5ec2e7_token\r\n"
                                         "X-Forwarded-For: 203.0.113.9\r\n"
                                         "User-Agent: Firefox/99\r\n"
                                         "Referer: https://where.example/\r\n";
        EXPECT_EQ(served.ask("/collections/segments/items?bbox=161.5,84.51,162,85", headers).status,
                  200);
        EXPECT_EQ(served.ask("/tiles/WebMercatorQuad/14/15678/1?where=1", headers).status, 400);
        EXPECT_EQ(served.ask("/v1/trips/" + hash, headers).status, 401);
        EXPECT_EQ(served.ask("/84.51/161.5", headers).status, 404);
    }
    const auto log = ::testing::internal::GetCapturedStdout();
    EXPECT_THAT(log, HasSubstr("Z GET /collections/{id}/items 200 "));
    EXPECT_THAT(log, HasSubstr("Z GET /tiles/{set}/{z}/{row}/{column} 400 "));
    EXPECT_THAT(log, HasSubstr("Z GET /v1/trips/{sha256} 401 "));
    EXPECT_THAT(log, HasSubstr("Z GET other 404 "));
    for (const std::string_view told : {"127.0.0.1",
                                        "203.0.113",
                                        "mac_",
                                        "5ec2e7",
                                        "Firefox",
                                        "where",
                                        "bbox",
                                        "84.51",
                                        "161.5",
                                        "15678",
                                        "?",
                                        "dddd"}) {
        EXPECT_THAT(log, Not(HasSubstr(std::string{told})));
    }
}

TEST(ApiServer, LetsPagesOfListedSitesReadWhatIsPublicAlone) {
    HttpServerConfig config{.port = 0};
    config.allowed_origins = {"https://maps.example"};
    const ServedWorld served{config};
    make_uploads_folder(served.file);
    const std::string_view of_page = "Origin: https://maps.example\r\n";
    EXPECT_EQ(served.ask("/collections", of_page).headers.at("access-control-allow-origin"),
              "https://maps.example");
    EXPECT_FALSE(served.ask("/v1/trips", of_page).headers.contains("access-control-allow-origin"));
    HttpClient client{served.port};
    for (const auto& [target, status] : {std::pair{"/collections", 204}, {"/v1/trips", 405}}) {
        client.send(fmt::format("OPTIONS {} HTTP/1.1\r\nHost: localhost\r\n{}"
                                "Access-Control-Request-Method: GET\r\n\r\n",
                                target,
                                of_page));
        const auto answer = client.answer();
        EXPECT_EQ(answer.status, status) << target;
        EXPECT_EQ(answer.headers.contains("access-control-allow-origin"), status == 204) << target;
    }
}

} // namespace
} // namespace macadam::testing
