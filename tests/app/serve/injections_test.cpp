// Requests made to harm, at every place of a request that a client fills in: none fails, none is
// answered with what is not public, none changes anything.

#include "app/cli/console.hpp"
#include "app/serve/api_server.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/text/json.hpp"
#include "storage/uploads/access_token.hpp"
#include "storage/uploads/upload_database.hpp"
#include "support/files/files.hpp"
#include "support/http/hostile_texts.hpp"
#include "support/http/http_client.hpp"
#include "support/roads/store_world.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cctype>
#include <cstdint>
#include <filesystem>
#include <future>
#include <set>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace macadam::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

/// Encodes every byte of a text for a part of an address, but letters and digits.
std::string encoded(std::string_view text) {
    std::string result;
    for (const char letter : text) {
        const auto byte = static_cast<unsigned char>(letter);
        result += std::isalnum(byte) != 0 && byte < 0x80 ? std::string{letter}
                                                         : fmt::format("%{:02X}", byte);
    }
    return result;
}

/// Doubles the quotes of a text, as who puts it into a filter should.
std::string quoted(std::string_view text) {
    std::string result;
    for (const char letter : text) {
        result += letter == '\'' ? "''" : std::string{letter};
    }
    return "'" + result + "'";
}

std::string joined(const auto& texts) {
    std::string all;
    for (const auto& text : texts) {
        all += text;
        all += ' ';
    }
    return all;
}

/// Server of a database with a token and a file beside it that nobody may see.
struct AttackedWorld {
    AttackedWorld() {
        while (ask("GET", "/tiles.json").status != 200) { // the test's time limit ends it
            std::this_thread::sleep_for(std::chrono::milliseconds{20});
        }
    }
    ~AttackedWorld() { stop.request_stop(); }
    AttackedWorld(const AttackedWorld&) = delete;
    AttackedWorld& operator=(const AttackedWorld&) = delete;

    static fs::path new_file() {
        const auto path = test_folder() / "roads.gpkg";
        {
            auto store = new_store(path);
            import_trips(store, 3);
        }
        written(path.parent_path(), "secret.txt", "canary of a file");
        make_uploads_folder(path);
        auto uploads = open_uploads(path);
        create_token(uploads,
                     {.id = {},
                      .owner = "canary of an owner",
                      .scope = TokenScope::upload,
                      .expires_ms = 4'000'000'000'000});
        return path;
    }

    /// What nobody may change: values, tokens, and which files there are.
    std::string kept() const {
        auto text = StoreReader::open(file).digest();
        auto uploads = open_uploads(file);
        text += fmt::format("\n{} tokens, {} uploads",
                            uploads.number("SELECT count(*) FROM token"),
                            uploads.number("SELECT count(*) FROM upload"));
        std::set<std::string> names;
        for (const auto& each : fs::recursive_directory_iterator{file.parent_path()}) {
            const auto name = each.path().string();
            const bool comes_and_goes = name.ends_with("-wal") || name.ends_with("-shm") ||
                                        name.ends_with("-network"); // which readers write
            if (!comes_and_goes) {
                names.insert(name);
            }
        }
        for (const auto& name : names) {
            text += "\n" + name;
        }
        return text;
    }

    /// Asks as another client each time, of whom none asks too often.
    Answer ask(std::string_view method, std::string_view target, std::string_view headers = {}) {
        HttpClient client{port};
        client.send(fmt::format("{} {} HTTP/1.1\r\nHost: localhost\r\nX-Forwarded-For: 10.{}.{}.{}"
                                "\r\n{}{}\r\n{}",
                                method,
                                target,
                                clients / 65536,
                                clients / 256 % 256,
                                clients % 256,
                                headers,
                                method == "PUT" ? "Content-Length: 1\r\n" : "",
                                method == "PUT" ? "x" : ""));
        ++clients;
        return client.answer();
    }

    fs::path file = new_file();
    int clients = 0;
    std::stop_source stop;
    std::promise<std::uint16_t> started;
    std::jthread server{[this] {
        HttpServerConfig config{.port = 0};
        config.behind_proxy = true;
        serve_database(file,
                       Audience::anyone,
                       config,
                       {},
                       Console{Verbosity::quiet, stop.get_token()},
                       [this](std::uint16_t its_port) { started.set_value(its_port); },
                       {.workers = 0});
    }};
    std::uint16_t port = started.get_future().get();
};

/// Place of a request into which a text is put.
struct Place {
    std::string method;
    std::string target;
    std::string headers{};
    bool selects = false; ///< features that have the text as a value, of which there are none
};

std::vector<Place> places_of(std::string_view text) {
    const auto word = encoded(text);
    const std::string items = "/collections/segments/items";
    const auto as_json = encoded(fmt::format(R"({{"op":"=","args":[{{"property":"name"}},{}]}})",
                                             json_text(std::string{text})));
    std::vector<Place> places{
        {"GET", items + "?name=" + word, {}, true},
        {"GET", items + "?class=" + word, {}, true},
        {"GET", items + "?filter=" + encoded("name = " + quoted(text)), {}, true},
        {"GET", items + "?filter-lang=cql2-json&filter=" + as_json, {}, true},
        {"GET", items + "?f=html&name=" + word},
        {"GET", items + "?filter=" + word},
        {"GET", items + "?filter=" + encoded("name = '") + word + "%27"},
        {"GET", items + "?filter-lang=cql2-json&filter=" + word},
        {"GET", items + "?filter-lang=" + word + "&filter=true"},
        {"GET", items + "?" + word + "=1"},
        {"GET", "/collections/" + word},
        {"GET", "/collections/" + word + "/items"},
        {"GET", items + "/" + word},
        {"GET", items + "/" + word + "?f=html"},
        {"GET", "/tiles/" + word + "/0/0/0"},
        {"GET", "/tiles/WebMercatorQuad/" + word + "/0/0"},
        {"GET", "/tiles/WebMercatorQuad/0/0/0?v=" + word},
        {"GET", "/segments/" + word + ".json"},
        {"GET", "/names.json?starts=" + word},
        {"GET", "/" + word},
        {"GET", "/?f=" + word},
        {"GET", "/v1/trips/" + word},
        {"PUT", "/v1/trips/" + word},
        {"DELETE", "/v1/trips/" + word},
        {"GET", "/queue/" + word}};
    for (const auto* const name :
         {"iri", "datetime", "bbox", "bbox-crs", "limit", "offset", "after", "crs", "filter-crs"}) {
        places.push_back({"GET", fmt::format("{}?{}={}", items, name, word)});
    }
    if (text.find_first_of("\r\n\0"sv) == std::string_view::npos) { // else it ends the header
        for (const auto* const name : {"Authorization: Bearer ",
                                       "Authorization: ",
                                       "X-Macadam-User: ",
                                       "If-None-Match: ",
                                       "Range: ",
                                       "Content-Disposition: attachment; filename="}) {
            places.push_back({"GET", "/v1/trips", fmt::format("{}{}\r\n", name, text)});
            places.push_back({"GET", items, fmt::format("{}{}\r\n", name, text)});
        }
    }
    return places;
}

void expect_nothing_of_others(const Answer& answer, const std::string& request) {
    for (const auto* const secret :
         {"canary of", "SQLite format", "gpkg_contents", "root:", "car-1", "trip-1", "HOME="}) {
        EXPECT_THAT(answer.body, Not(HasSubstr(secret))) << request;
    }
    EXPECT_FALSE(answer.headers.contains("x-injected")) << request;
    EXPECT_EQ(answer.headers.at("x-content-type-options"), "nosniff") << request;
}

TEST(Injections, OfSqlAreTextAtEveryPlace) {
    AttackedWorld world;
    const auto before = world.kept();
    int requests = 0;
    for (const auto text : sql_injections) {
        for (const auto& [method, target, headers, selects] : places_of(text)) {
            const auto request = fmt::format("{} {} {}", method, target, headers);
            const auto answer = world.ask(method, target, headers);
            ++requests;
            ASSERT_TRUE(answer.status >= 200 && answer.status < 500)
                << request << answer.status << answer.body;
            expect_nothing_of_others(answer, request);
            if (selects && answer.status == 200) {
                EXPECT_EQ(nlohmann::json::parse(answer.body).at("numberMatched"), 0) << request;
            }
            EXPECT_TRUE(!selects || answer.status == 200 || answer.status == 400) << request;
        }
    }
    EXPECT_GT(requests, 2000);
    EXPECT_EQ(world.kept(), before);
    EXPECT_GT(nlohmann::json::parse(world.ask("GET", "/collections/segments/items").body)
                  .at("numberMatched"),
              0);
}

/// Expects that an answer is no page with markup of others.
void expect_text_alone(const Answer& answer, const std::string& request) {
    if (answer.headers.at("content-type").starts_with("text/html")) {
        for (const auto* const opened : {"<script",
                                         "<ScRiPt",
                                         "<img",
                                         "<svg",
                                         "<body onload",
                                         "<details",
                                         "<a href=\"javascript",
                                         "\" on",
                                         "<iframe",
                                         "<object",
                                         "<meta http",
                                         "<base",
                                         "<style",
                                         "<form",
                                         "<!--",
                                         "<![",
                                         "<?xml",
                                         "<!DOCTYPE x",
                                         "<math"}) {
            EXPECT_THAT(answer.body, Not(HasSubstr(opened))) << request;
        }
    } else {
        EXPECT_THAT(answer.headers.at("content-type"), Not(HasSubstr("xml"))) << request;
    }
    EXPECT_THAT(answer.headers.at("content-security-policy"), HasSubstr("default-src 'none'"))
        << request;
}

TEST(Injections, OfMarkupAreTextInEveryAnswer) {
    AttackedWorld world;
    const auto before = world.kept();
    int pages = 0;
    for (const auto text : markup_injections) {
        for (const auto& [method, target, headers, selects] : places_of(text)) {
            const auto request = fmt::format("{} {} {}", method, target, headers);
            const auto answer = world.ask(method, target, headers + "Accept: text/html\r\n");
            ASSERT_TRUE(answer.status >= 200 && answer.status < 500)
                << request << answer.status << answer.body;
            expect_nothing_of_others(answer, request);
            expect_text_alone(answer, request);
            pages += answer.headers.at("content-type").starts_with("text/html") ? 1 : 0;
        }
    }
    EXPECT_GT(pages, 100);
    EXPECT_EQ(world.kept(), before);
}

TEST(Injections, OfMarkupInNamesOfRoadsAreTextInEveryPage) {
    const auto name = joined(markup_injections);
    AttackedWorld world;
    Database{world.file, Database::Access::write}.prepare("UPDATE way SET name = ?").run(name);
    const std::string items = "/collections/segments/items";
    nlohmann::json page;
    for (const auto* const target : {"/collections/segments/items", "/collections/worst/items"}) {
        while (page = nlohmann::json::parse(world.ask("GET", target).body),
               page.at("features").empty() || page["features"][0]["properties"]["name"] != name) {
            std::this_thread::sleep_for(
                std::chrono::milliseconds{50}); // the server looks each second
        }
        const auto id = page["features"][0]["id"].get<std::string>();
        for (const auto& shown : {std::string{target}, fmt::format("{}/{}", target, id)}) {
            const auto answer = world.ask("GET", shown + "?f=html");
            EXPECT_EQ(answer.status, 200) << shown;
            ASSERT_TRUE(answer.headers.at("content-type").starts_with("text/html"));
            EXPECT_THAT(answer.body, HasSubstr("&lt;ScRiPt&gt;alert(1)")) << shown;
            EXPECT_THAT(answer.body, HasSubstr("&amp;lt;script&amp;gt;")) << shown;
            expect_text_alone(answer, shown);
        }
    }
}

TEST(Injections, OfPathsLeadOutOfNoPage) {
    AttackedWorld world;
    const auto before = world.kept();
    for (const auto path : path_traversals) {
        for (const auto* const below : {"",
                                        "/assets",
                                        "/drive",
                                        "/queue",
                                        "/words",
                                        "/segments",
                                        "/collections",
                                        "/collections/segments/items",
                                        "/tiles",
                                        "/map/tiles",
                                        "/v1/trips",
                                        "/v1"}) {
            const auto target = fmt::format("{}{}", below, path);
            const auto answer = world.ask("GET", target);
            EXPECT_TRUE(answer.status == 404 || answer.status == 400 || answer.status == 401)
                << target << ' ' << answer.status << answer.body;
            expect_nothing_of_others(answer, target);
        }
    }
    EXPECT_EQ(world.kept(), before);
}

} // namespace
} // namespace macadam::testing
