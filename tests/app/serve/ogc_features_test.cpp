// OGC API - Features over real sockets. Numbers in brackets are those of the abstract tests of OGC
// 17-069r4 (annex A) and 18-058r1, which these follow.

#include "app/http/http_message.hpp"
#include "app/query/section_query.hpp"
#include "app/serve/ogc/segment_selections.hpp"
#include "storage/exports/export.hpp"
#include "support/http/served_store.hpp"
#include "support/program/shell.hpp"
#include "support/roads/store_world.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace macadam::testing {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

using Served = ServedWorld;

std::string link_to(const json& page, std::string_view rel) {
    for (const auto& link : page.at("links")) {
        if (link.at("rel") == rel) {
            return link.at("href");
        }
    }
    return "";
}

/// Ids of all features over all pages.
std::vector<std::string> ids_over_pages(const Served& served, json page) {
    std::vector<std::string> ids;
    for (int pages = 0; pages < 1000; ++pages) {
        for (const auto& feature : page.at("features")) {
            ids.push_back(feature.at("id"));
        }
        const auto next = link_to(page, "next");
        if (next.empty()) {
            break;
        }
        page = served.follow(next);
    }
    return ids;
}

std::vector<std::string> exported_ids(const std::filesystem::path& file,
                                      const std::optional<GeoBox>& box = {}) {
    SegmentFilter filter;
    filter.box = box;
    std::vector<std::string> ids;
    StoreReader::open(file).visit(
        filter, [&](const SegmentRecord& record) { ids.push_back(name_of(record.segment.key)); });
    return ids;
}

TEST(OgcFeatures, LinksFromTheLandingPage) { // A.2.2 core/root-op, root-success
    const Served served;
    const auto page = served.page("/");
    for (const auto* rel : {"self", "service-desc", "service-doc", "conformance", "data"}) {
        EXPECT_NE(link_to(page, rel), "") << rel;
    }
    EXPECT_EQ(served.follow(link_to(page, "service-desc")).at("openapi"), "3.0.3");     // A.2.3
    EXPECT_GE(served.follow(link_to(page, "conformance")).at("conformsTo").size(), 5U); // A.2.4
    EXPECT_EQ(served.follow(link_to(page, "data")).at("collections").size(), 3U);       // A.2.5
}

TEST(OgcFeatures, DescribesCollections) { // A.2.5, A.2.6 core/fc-md-success, sfc-md-success
    const Served served;
    const auto page = served.page("/collections");
    for (const auto& collection : page.at("collections")) {
        const auto id = collection.at("id").get<std::string>();
        EXPECT_EQ(served.page("/collections/" + id), collection);
        EXPECT_EQ(collection.at("extent").at("spatial").at("bbox")[0].size(), 4U);
        EXPECT_THAT(collection.at("crs")[0].get<std::string>(), HasSubstr("CRS84"));
        EXPECT_EQ(served.follow(link_to(collection, "items")).at("type"), "FeatureCollection");
    }
}

TEST(OgcFeatures, ServesTheSectionsThatQueriesCut) {
    const auto table = test_folder() / "sections.csv";
    const SectionOptions options{.route = {},
                                 .best = {},
                                 .along = {},
                                 .sections = table,
                                 .length_m = 100,
                                 .homogeneous = false,
                                 .exclude = {},
                                 .exclude_radius_m = 20};
    const Served served{{.port = 0}, {}, options};
    written(table.parent_path(), "sections.csv", "section,way_id,from_m,to_m\nhigh,1,0,200\n");
    std::vector<NamedSection> cut;
    each_section(StoreReader::open(served.file), options, {}, [&](const NamedSection& section) {
        cut.push_back(section);
    });
    ASSERT_EQ(cut.size(), 2U);
    const auto page = served.page("/collections/sections/items");
    ASSERT_EQ(page.at("numberMatched"), cut.size());
    for (std::size_t i = 0; i < cut.size(); ++i) {
        const auto& properties = page.at("features")[i].at("properties");
        EXPECT_EQ(properties.at("section"), "high");
        EXPECT_NEAR(properties.at("iri").get<double>(),
                    cut[i].section.measured.mean.iri,
                    0.0005); // its third decimal
        EXPECT_EQ(page.at("features")[i].at("geometry").at("type"), "LineString");
    }
    EXPECT_EQ(served.page("/collections/sections/items?filter=iri%20%3E%201000").at("features"),
              json::array());
    EXPECT_EQ(served.page("/collections/sections/items/2"), [&] {
        auto feature = page.at("features")[1];
        feature["links"] = served.page("/collections/sections/items/2").at("links");
        return feature;
    }());
    EXPECT_TRUE(
        served.page("/collections/sections/queryables").at("properties").contains("iri_worst"));
    EXPECT_THAT(served.page("/api").dump(), HasSubstr("\"sections\""));
}

TEST(OgcFeatures, GivesTheFeaturesThatExportsGive) { // A.2.7 core/fc-op, fc-response
    const Served served;
    const auto page = served.page("/collections/segments/items?limit=10000");
    const auto ids = exported_ids(served.file);
    ASSERT_EQ(ids.size(), 20U);
    EXPECT_EQ(page.at("numberMatched"), ids.size());
    EXPECT_EQ(page.at("numberReturned"), ids.size());
    export_segments(StoreReader::open(served.file), {}, served.file.parent_path() / "all.geojson");
    std::ifstream in{served.file.parent_path() / "all.geojson"};
    EXPECT_EQ(page.at("features"), json::parse(in).at("features"));
}

TEST(OgcFeatures, PagesWithoutRepeatingOrMissingAFeature) { // core/fc-links, fc-limit-response-1
    const Served served;
    EXPECT_EQ(ids_over_pages(served, served.page("/collections/segments/items?limit=7")),
              exported_ids(served.file));
    EXPECT_EQ(ids_over_pages(served, served.page("/collections/segments/items?limit=7&offset=7")),
              [&] {
                  auto ids = exported_ids(served.file);
                  ids.erase(ids.begin(), ids.begin() + 7);
                  return ids;
              }());
    EXPECT_EQ(served.page("/collections/segments/items?offset=1000000").at("numberReturned"), 0);
}

TEST(OgcFeatures, KeepsTheFilterOverPages) { // core/fc-links
    const Served served;
    const auto ids = ids_over_pages(
        served, served.page("/collections/segments/items?limit=3&direction=backward"));
    ASSERT_GT(ids.size(), 5U);
    for (const auto& id : ids) {
        EXPECT_THAT(id, HasSubstr("1-"));
    }
}

TEST(OgcFeatures, SelectsByBox) { // core/fc-bbox-definition, fc-bbox-response
    const Served served;
    const auto all = served.page("/collections/segments/items?limit=10000");
    const auto first = all.at("features")[0].at("geometry").at("coordinates")[0];
    const double lon = first[0], lat = first[1];
    const GeoBox box{lon - 1e-4, lat - 1e-4, lon + 1e-4, lat + 1e-4};
    const auto text =
        fmt::format("{},{},{},{}", box.west_deg, box.south_deg, box.east_deg, box.north_deg);
    const auto ids =
        ids_over_pages(served, served.page("/collections/segments/items?bbox=" + text));
    EXPECT_EQ(ids, exported_ids(served.file, box));
    EXPECT_LT(ids.size(), all.at("features").size());
    const auto turned = fmt::format(
        "{},{},{},{}", box.south_deg, box.west_deg, box.north_deg, box.east_deg); // A.2.7 of Part 2
    EXPECT_EQ(served
                  .page("/collections/segments/items?bbox=" + turned +
                        "&bbox-crs=http://www.opengis.net/def/crs/EPSG/0/4326")
                  .at("numberMatched"),
              ids.size());
    EXPECT_EQ(served.page("/collections/segments/items?bbox=170,-50,-170,-40").at("numberMatched"),
              0);
}

TEST(OgcFeatures, SelectsByTime) { // core/fc-time-definition, fc-time-response
    const Served served;
    const auto matched = [&](const std::string& time) {
        return served.page("/collections/segments/items?datetime=" + time)
            .at("numberMatched")
            .get<int>();
    };
    const auto feature = served.page("/collections/segments/items?limit=1").at("features")[0];
    const auto day = feature.at("properties").at("last_seen").get<std::string>();
    EXPECT_GT(matched(day), 0);
    EXPECT_GT(matched(day + "/.."), 0);
    EXPECT_GT(matched("../" + day), 0);
    EXPECT_GT(matched("2000-01-01T00:00:00Z/2100-01-01T00:00:00Z"), 0);
    EXPECT_EQ(matched("1999-01-01/2000-01-01"), 0);
    EXPECT_EQ(matched("2100-01-01"), 0);
}

TEST(OgcFeatures, GivesSingleFeatures) { // A.2.8 core/f-op, f-success, f-links
    const Served served;
    const auto feature = served.page("/collections/segments/items?limit=1").at("features")[0];
    auto alone = served.page("/collections/segments/items/" + feature.at("id").get<std::string>());
    EXPECT_NE(link_to(alone, "self"), "");
    EXPECT_NE(link_to(alone, "collection"), "");
    alone.erase("links");
    EXPECT_EQ(alone, feature);
    for (const auto* id : {"1+9999", "nonsense", "1%2B0", "%27;DROP%20TABLE%20segment"}) {
        EXPECT_EQ(served.ask(fmt::format("/collections/segments/items/{}", id)).status, 404) << id;
    }
}

TEST(OgcFeatures, TransformsCoordinates) { // 18-058r1 A.1 to A.6
    const Served served;
    const std::string uri = "http://www.opengis.net/def/crs/";
    const auto in = [&](const std::string& crs) {
        const auto answer = served.ask("/collections/segments/items?limit=1&crs=" + uri + crs);
        EXPECT_EQ(answer.headers.at("content-crs"), "<" + uri + crs + ">");
        return json::parse(answer.body).at("features")[0].at("geometry").at("coordinates")[0];
    };
    const auto degrees = in("OGC/1.3/CRS84"), turned = in("EPSG/0/4326"),
               metres = in("EPSG/0/3857");
    EXPECT_EQ(degrees[0], turned[1]);
    EXPECT_EQ(degrees[1], turned[0]);
    EXPECT_NEAR(
        metres[0].get<double>(), degrees[0].get<double>() * 111319.4908, 0.02); // 7 decimals
    EXPECT_EQ(served.ask("/collections/segments/items?crs=EPSG:31256").status, 400);
    EXPECT_EQ(served.ask("/collections/segments/items?bbox=1,2,3,4&bbox-crs=x").status, 400);
}

TEST(OgcFeatures, SelectsByAFilter) { // 19-079r2 A.4 filter, A.5 features-filter
    const Served served;
    const auto all = served.page("/collections/segments/items?limit=10000").at("features");
    const auto matched = [&](const std::string& filter, const std::string& more = "") {
        return served
            .page("/collections/segments/items?limit=3&filter=" + percent_encoded(filter) + more)
            .at("numberMatched")
            .get<std::size_t>();
    };
    const auto count_if = [&](const auto& test) {
        return static_cast<std::size_t>(std::ranges::count_if(
            all, [&](const json& feature) { return test(feature.at("properties")); }));
    };
    const double iri = all[7].at("properties").at("iri");
    const auto above = count_if([&](const json& row) { return row.at("iri") > iri; });
    ASSERT_GT(above, 0U);
    EXPECT_EQ(matched(fmt::format("iri > {}", iri)), above);
    EXPECT_EQ(matched(fmt::format(R"({{"op":">","args":[{{"property":"iri"}},{}]}})", iri),
                      "&filter-lang=cql2-json"),
              above);
    EXPECT_EQ(matched(fmt::format("iri > {} AND direction = 'forward'", iri)),
              matched(fmt::format("iri > {}", iri), "&direction=forward"));
    EXPECT_EQ(matched("true"), all.size());
    const auto at = all[0].at("geometry").at("coordinates")[0];
    const double lon = at[0], lat = at[1];
    const auto here = matched(fmt::format("S_INTERSECTS(geometry, POINT({} {}))", lon, lat));
    EXPECT_GT(here, 0U);
    EXPECT_LT(here, all.size());
    EXPECT_EQ(matched(fmt::format("S_INTERSECTS(geometry, POINT({} {}))", lat, lon),
                      "&filter-crs=http://www.opengis.net/def/crs/EPSG/0/4326"),
              here);
    const auto page = served.page("/collections/segments/items?limit=3&filter=iri%3E0");
    EXPECT_EQ(ids_over_pages(served, page), exported_ids(served.file)); // links keep it
}

TEST(OgcFeatures, RefusesBadFilters) { // 19-079r2 A.4 filter-param, filter-lang-param
    const Served served;
    for (const auto* query : {"filter=rri%3E4",
                              "filter=",
                              "filter=iri",
                              "filter=true&filter-lang=sql",
                              "filter=true&filter-crs=EPSG:4326"}) {
        const auto answer = served.ask(fmt::format("/collections/segments/items?{}", query));
        EXPECT_EQ(answer.status, 400) << query;
        EXPECT_EQ(answer.headers.at("content-type"), "application/problem+json");
    }
    EXPECT_EQ(served.ask("/collections/worst/items?filter=true").status, 200);
    EXPECT_EQ(served.ask("/collections/events/items?filter=severity%20LIKE%20'%25'").status, 200);
}

TEST(OgcFeatures, ListsWhatFiltersMayUse) { // 19-079r2 A.2 queryables
    const Served served;
    for (const auto* id : {"segments", "worst", "events"}) {
        const auto collection = served.page(fmt::format("/collections/{}", id));
        const auto schema =
            served.follow(link_to(collection, "http://www.opengis.net/def/rel/ogc/1.0/queryables"));
        EXPECT_EQ(schema.at("type"), "object");
        EXPECT_EQ(schema.at("properties").at("geometry").at("x-ogc-role"), "primary-geometry");
        ASSERT_GT(schema.at("properties").size(), 5U);
        for (const auto& [name, property] : schema.at("properties").items()) {
            const auto filter = percent_encoded("\"" + name + "\" IS NULL OR true");
            EXPECT_EQ(served.ask(fmt::format("/collections/{}/items?filter={}", id, filter)).status,
                      200)
                << name;
        }
    }
    EXPECT_EQ(served.ask("/collections/none/queryables").status, 404);
}

TEST(OgcFeatures, TakesBoxesWithoutWidthOrHeight) {
    const Served served;
    const auto at = served.page("/collections/segments/items?limit=1")
                        .at("features")[0]
                        .at("geometry")
                        .at("coordinates")[0];
    EXPECT_GT(served
                  .page(fmt::format("/collections/segments/items?bbox={0},{1},{0},{1}",
                                    at[0].get<double>(),
                                    at[1].get<double>()))
                  .at("numberMatched"),
              0);
}

TEST(OgcFeatures, NamesTheParameterThatItRefuses) {
    const Served served;
    EXPECT_THAT(served.ask("/collections/segments/items?bbox=1,4,3,2").body,
                AllOf(HasSubstr("bbox is '1,4,3,2'"), Not(HasSubstr("--bbox"))));
    for (const auto* query : {"limit=1&limit=2", "bbox=1,2,3,4&bbox=1,2,3,4", "iri=1&iri=1"}) {
        const auto answer = served.ask(fmt::format("/collections/segments/items?{}", query));
        EXPECT_EQ(answer.status, 400) << query;
        EXPECT_THAT(answer.body, HasSubstr("is given twice")) << query;
    }
}

TEST(OgcFeatures, RefusesBadParameters) { // core/query-param-unknown, query-param-invalid
    const Served served;
    for (const auto* query :
         {"limit=0",        "limit=-1",         "limit=x",
          "limit=1e3",      "offset=-1",        "bbox=1,2,3",
          "bbox=a,b,c,d",   "bbox=nan,0,1,1",   "bbox=inf,0,1,1",
          "bbox=1,2,3,4,5", "bbox=0,91,1,92",   "datetime=yesterday",
          "datetime=../..", "datetime=2026-13", "datetime=2026-02-01/2026-01-01",
          "unknown=1",      "after=x",          "f=xml",
          "crs=EPSG:4326",  "%27%20OR%201=1",   "datetime=2026-01-01/x"}) {
        const auto answer = served.ask(fmt::format("/collections/segments/items?{}", query));
        EXPECT_EQ(answer.status, 400) << query;
        EXPECT_EQ(answer.headers.at("content-type"), "application/problem+json");
        EXPECT_THAT(answer.body, Not(HasSubstr("roads.gpkg")));
    }
    for (const auto* path :
         {"/nothing", "/collections/x", "/collections/x/items", "/collections/x/items/1"}) {
        EXPECT_EQ(served.ask(path).status, 404) << path;
    }
}

TEST(OgcFeatures, TakesInjectionsAsText) {
    const Served served;
    for (const auto* text : {"'%20OR%20'1'='1",
                             "%22;DROP%20TABLE%20segment;--",
                             "%3Cscript%3E",
                             "%25",
                             "1%20UNION%20SELECT%20*%20FROM%20trip",
                             "$(id)",
                             "..%2F..%2Fetc%2Fpasswd"}) {
        EXPECT_EQ(served.page(fmt::format("/collections/segments/items?name={}", text))
                      .at("numberMatched"),
                  0);
        const auto html =
            served.ask(fmt::format("/collections/segments/items?name={}&f=html", text));
        EXPECT_EQ(html.status, 200);
        EXPECT_THAT(html.body, Not(HasSubstr("<script>")));
    }
    EXPECT_GT(served.page("/collections/segments/items").at("numberMatched"), 0);
}

TEST(OgcFeatures, SelectsByProperty) { // core/fc-filter parameters
    const Served served;
    const auto all = served.page("/collections/segments/items?limit=10000");
    const auto& shown = all.at("features")[3].at("properties");
    std::size_t expected = 0;
    for (const auto& feature : all.at("features")) {
        expected += feature.at("properties").at("iri") == shown.at("iri") ? 1 : 0;
    }
    EXPECT_EQ(served.page(fmt::format("/collections/segments/items?iri={}", shown.at("iri").dump()))
                  .at("numberMatched"),
              expected);
    EXPECT_EQ(served.page("/collections/segments/items?name=Rue%20de%20l%27%C3%89p%C3%A9e%20100%25")
                  .at("numberMatched"),
              all.at("numberMatched"));
}

TEST(OgcFeatures, ShowsPagesToBrowsers) { // html
    const Served served;
    const auto page = served.ask("/collections/segments/items", "Accept: text/html,*/*\r\n");
    EXPECT_EQ(page.headers.at("content-type"), "text/html; charset=utf-8");
    EXPECT_THAT(page.body, HasSubstr("<a href=\"http://127.0.0.1"));
    EXPECT_EQ(served.ask("/", "Accept: application/json\r\n").headers.at("content-type"),
              "application/json");
}

TEST(OgcFeatures, FollowsTheDatabase) {
    const Served served;
    const auto before = served.ask("/collections/segments/items?limit=1");
    EXPECT_EQ(served
                  .ask("/collections/segments/items?limit=1",
                       "If-None-Match: " + before.headers.at("etag") + "\r\n")
                  .status,
              304);
    {
        auto store = RoadStore::open(served.file);
        import_trips(store, 5);
    }
    auto after = before;
    while (after.headers.at("etag") == before.headers.at("etag")) { // the test's time limit ends it
        std::this_thread::sleep_for(std::chrono::milliseconds{50});
        after = served.ask("/collections/segments/items?limit=1");
    }
    const auto passes = [](const Answer& answer) {
        return json::parse(answer.body).at("features")[0].at("properties").at("passes").get<int>();
    };
    EXPECT_EQ(passes(before), 3);
    EXPECT_EQ(passes(after), 5);
}

TEST(OgcFeatures, CountsRequestsByTheirPatterns) {
    const Served served;
    served.ask("/collections/segments/items?bbox=1.25,2.5,3.75,4.5");
    const auto metrics = served.ask("/metrics").body;
    EXPECT_THAT(metrics, HasSubstr("route=\"/collections/{id}/items\",code=\"200\"} 1"));
    EXPECT_THAT(metrics, Not(HasSubstr("1.25")));
}

TEST(OgcFeatures, EndASelectionThatTakesTooLong) {
    TimeLimit over{std::chrono::milliseconds{-1}}, ample{std::chrono::hours{1}};
    EXPECT_THROW(over.check(), SelectionTooLong);
    EXPECT_NO_THROW(ample.check());
}

TEST(OgcFeatures, LinksToThePublicAddressBehindAProxy) {
    const Served served{{.port = 0, .behind_proxy = true, .hosts = {"roads.example.org"}},
                        {.base = "https://roads.example.org/iri"}};
    const auto page = served.page("/collections");
    EXPECT_EQ(link_to(page, "self"), "https://roads.example.org/iri/collections");
}

TEST(OgcFeatures, AreReadByGdal) {
    const Served served;
    const auto said = [&](const std::string& command) {
        return output_of(served.file.parent_path(),
                         fmt::format("{} OAPIF:http://127.0.0.1:{} segments -oo PAGE_SIZE=7",
                                     command,
                                     served.port));
    };
    EXPECT_THAT(said("ogrinfo -ro -so"),
                AllOf(HasSubstr("Feature Count: 20"),
                      HasSubstr("iri_low: Real"),
                      HasSubstr("passes: Integer"),
                      HasSubstr("last_seen: Date")));
    const auto csv = said("ogr2ogr -f CSV /vsistdout/");
    for (const auto& id : exported_ids(served.file)) {
        EXPECT_THAT(csv, HasSubstr(id));
    }
}

} // namespace
} // namespace macadam::testing
