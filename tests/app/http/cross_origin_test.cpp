// Which pages of other sites may read answers (CORS).

#include "app/http/cross_origin.hpp"

#include "app/http/http_server.hpp"
#include "support/http/http_client.hpp"
#include "support/http/text_server.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace macadam::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const std::string allow_origin = "access-control-allow-origin";

struct OpenServer {
    explicit OpenServer(std::vector<std::string> origins)
        : server{[&] {
                     auto made = text_config();
                     made.max_body_bytes = 100;
                     made.allowed_origins = std::move(origins);
                     return made;
                 }(),
                 text_handlers()} {}

    Answer ask(std::string_view method, std::string_view origin) const {
        HttpClient client{server.port()};
        client.send(fmt::format("{} /a HTTP/1.1\r\nHost: localhost\r\nContent-Length: 0\r\n"
                                "Origin: {}\r\nAccess-Control-Request-Method: GET\r\n\r\n",
                                method,
                                origin));
        return client.answer(method != "HEAD");
    }

    HttpServer server;
};

TEST(CrossOrigin, LetsPagesOfListedSitesReadAnswers) {
    const OpenServer open{{"https://a.example", "http://b.example:8080"}};
    for (const auto* const method : {"GET", "HEAD"}) {
        for (const auto* const origin : {"https://a.example", "http://b.example:8080"}) {
            const auto answer = open.ask(method, origin);
            EXPECT_EQ(answer.headers.at(allow_origin), origin);
            EXPECT_EQ(answer.status, 200);
        }
        for (const auto* const origin :
             {"http://a.example", "https://a.example.evil.example", "http://b.example", "null"}) {
            EXPECT_FALSE(open.ask(method, origin).headers.contains(allow_origin)) << origin;
        }
    }
    EXPECT_FALSE(open.ask("PUT", "https://a.example").headers.contains(allow_origin));
}

TEST(CrossOrigin, KeepsCachesFromMixingAnswersForSeveralSites) {
    const OpenServer open{{"https://a.example"}};
    for (const auto* const origin : {"https://a.example", "https://b.example"}) {
        HttpClient client{open.server.port()};
        client.send(
            fmt::format("GET /a HTTP/1.1\r\nHost: localhost\r\nOrigin: {}\r\n\r\n", origin));
        EXPECT_THAT(client.read_until("\r\n\r\n"), HasSubstr("Vary: Origin\r\n")) << origin;
    }
}

TEST(CrossOrigin, AnswersTheQuestionsThatBrowsersAskFirst) {
    const OpenServer open{{"https://a.example"}};
    const auto listed = open.ask("OPTIONS", "https://a.example");
    EXPECT_EQ(listed.status, 204);
    EXPECT_EQ(listed.headers.at(allow_origin), "https://a.example");
    EXPECT_EQ(listed.headers.at("access-control-allow-methods"), "GET, HEAD");
    EXPECT_THAT(listed.headers.at("access-control-allow-headers"), HasSubstr("Authorization"));
    const auto other = open.ask("OPTIONS", "https://b.example");
    EXPECT_EQ(other.status, 405);
    EXPECT_FALSE(other.headers.contains(allow_origin));
    EXPECT_EQ(OpenServer{{}}.ask("OPTIONS", "https://a.example").status, 405);
}

TEST(CrossOrigin, LetsNoTokenComeFromAnySite) {
    const OpenServer open{{"*"}};
    EXPECT_EQ(open.ask("GET", "https://b.example").headers.at(allow_origin), "*");
    const auto asked_first = open.ask("OPTIONS", "https://b.example");
    EXPECT_EQ(asked_first.status, 204);
    EXPECT_EQ(asked_first.headers.at(allow_origin), "*");
    EXPECT_THAT(asked_first.headers.at("access-control-allow-headers"),
                Not(HasSubstr("Authorization")));
    EXPECT_FALSE(asked_first.headers.contains("access-control-allow-credentials"));
}

TEST(CrossOrigin, TakesOriginsAsBrowsersSendThem) {
    for (const auto* const origin :
         {"*", "https://a.example", "http://localhost:3000", "http://[::1]:8080"}) {
        EXPECT_TRUE(is_origin(origin)) << origin;
    }
    for (const auto* const text : {"",
                                   "a.example",
                                   "https://",
                                   "https://a.example/",
                                   "https://a.example/map",
                                   "https://*.example",
                                   "https://a.example,https://b.example",
                                   "ftp://a.example",
                                   "null"}) {
        EXPECT_FALSE(is_origin(text)) << text;
    }
}

} // namespace
} // namespace macadam::testing
