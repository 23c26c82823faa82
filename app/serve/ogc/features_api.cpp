#include "app/serve/ogc/features_api.hpp"

#include "app/cli/arguments.hpp"
#include "app/serve/features/trip_features.hpp"
#include "app/serve/ogc/queryables.hpp"
#include "estimator/common/error.hpp"
#include "mapping/fusion/utc_month.hpp"
#include "mapping/geometry/antimeridian.hpp"
#include "mapping/geometry/area.hpp"
#include "storage/exports/export.hpp"
#include "storage/text/json.hpp"
#include "storage/text/utc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>

namespace macadam {
namespace {

constexpr std::string_view geojson_type = "application/geo+json";
constexpr std::string_view schema_type = "application/schema+json";

HttpResponse no_collection(std::string_view id) {
    return http_problem(404, fmt::format("there is no collection '{}'", id));
}

HttpResponse no_feature(const std::string& id) {
    return http_problem(404, fmt::format("there is no feature '{}'", id));
}

std::string day_json(const std::optional<std::int64_t>& ms) {
    return ms ? json_text(utc_day(*ms) + "T00:00:00Z") : "null";
}

/// Page of features with its links.
struct Page {
    std::string features; ///< with commas between them
    std::size_t returned = 0;
    std::size_t matched = 0;
    std::string next; ///< "after=..." or "offset=..."; "" = the last page
};

/// Appends a feature to a page, which is made large enough for all at once.
void add_feature(Page& page,
                 const Feature& feature,
                 std::span<const FeatureColumn> columns,
                 const ItemsQuery& query) {
    constexpr std::size_t usual_bytes = 640; // of a feature; a page also has its head
    if (page.returned++ == 0) {
        page.features.reserve(usual_bytes * (query.limit + 8));
    } else {
        page.features += ',';
    }
    append_feature(page.features, feature, columns, query.crs);
}

/// Keeps caches of several clients from handing on what depends on a token.
HttpResponse for_its_reader(const ApiContext& context, HttpResponse response) {
    if (context.is_operator) {
        response.cache_control = "no-store";
        response.etag.clear();
    }
    return response;
}

HttpResponse
page_response(const ApiContext& context, std::string_view id, const ItemsQuery& query, Page page) {
    const auto here = fmt::format("{}/collections/{}", context.base, id);
    const auto address = [&](const std::string& position) {
        return fmt::format("{}/items?limit={}{}{}", here, query.limit, position, query.rest);
    };
    const auto position = query.after        ? "&after=" + percent_encoded(*query.after)
                          : query.offset > 0 ? fmt::format("&offset={}", query.offset)
                                             : "";
    const auto asked_format = context.request.parameter("f");
    const auto format = asked_format ? "&f=" + percent_encoded(*asked_format) : "";
    std::vector<ApiLink> links{{address(position) + format, "self", geojson_type},
                               {address(position) + "&f=html", "alternate", "text/html"},
                               {here, "collection", "application/json"}};
    if (!page.next.empty()) {
        links.push_back({address("&" + page.next) + format, "next", geojson_type});
    }
    JsonObject collection;
    collection.add("type", "FeatureCollection")
        .add("numberMatched", static_cast<std::int64_t>(page.matched))
        .add("numberReturned", static_cast<std::int64_t>(page.returned))
        .add("links", JsonRaw{links_text(links)});
    auto head = collection.text();
    head.back() = ','; // instead of its brace
    auto text = std::move(page.features);
    text.insert(0, head + R"("features":[)").append("]}");
    auto response = api_page(context, std::string{id}, std::move(text), geojson_type);
    response.headers.emplace_back("Content-Crs", fmt::format("<{}>", uri_of(query.crs)));
    return for_its_reader(context, std::move(response));
}

HttpResponse feature_response(const ApiContext& context,
                              const Collection& collection,
                              const Feature& feature,
                              CoordinateReference crs) {
    const auto here = fmt::format("{}/collections/{}", context.base, collection.id);
    const auto links = links_text(
        {{fmt::format("{}/items/{}", here, percent_encoded(feature.id)), "self", geojson_type},
         {here, "collection", "application/json"}});
    std::string text;
    append_feature(text, feature, collection.columns(), crs, links);
    auto response = api_page(context, feature.id, std::move(text), geojson_type);
    response.headers.emplace_back("Content-Crs", fmt::format("<{}>", uri_of(crs)));
    return for_its_reader(context, std::move(response));
}

Area area_of(const GeoBox& box) {
    std::vector<Polygon> polygons;
    for (const auto& [west, south, east, north] : parts_on_globe(box)) {
        polygons.push_back({{{south, west}, {south, east}, {north, east}, {north, west}}});
    }
    return Area{polygons};
}

/// Tests whether the days between the first and the last pass of a feature, or its one day, meet a
/// period.
bool is_seen_in(const Feature& feature,
                std::span<const FeatureColumn> columns,
                const Period& period) {
    const auto day = [&](std::string_view name) -> std::optional<std::string> {
        const auto column = std::ranges::find(columns, name, &FeatureColumn::name);
        return column == columns.end() ? std::nullopt
                                       : plain_text(column->type, column->value(feature.row));
    };
    const auto only = day("day");
    const auto first = only ? only : day("first_seen"), last = only ? only : day("last_seen");
    return first && last && (!period.until_ms || *first <= utc_day(*period.until_ms - 1)) &&
           (!period.from_ms || *last >= utc_day(*period.from_ms));
}

/// Refuses here what the database would refuse, for whose failures a client is not to blame.
void expect_known_period(const StoreReader& store, const ItemsQuery& query) {
    const auto is_whole = [](const std::optional<std::int64_t>& border_ms) {
        return !border_ms || month_begin_ms(*border_ms) == *border_ms;
    };
    if (query.period && store.shows_published_alone() &&
        !(is_whole(query.period->from_ms) && is_whole(query.period->until_ms))) {
        throw UsageError{"values of a crowd database are given by whole months, expected a "
                         "datetime such as 2026-03-01/2026-05-31"};
    }
}

} // namespace

// -------------------------------------------------------------------------------- collections

std::vector<const Collection*> FeaturesApi::collections_for(bool is_operator) const {
    std::vector<const Collection*> shown;
    for (const auto& collection : known_collections()) {
        const bool is_there = collection.id != "sections" || sections_options_;
        if (is_there && (is_operator || !collection.is_of_operator)) {
            shown.push_back(&collection);
        }
    }
    return shown;
}

const Collection* FeaturesApi::find(const ApiContext& context, std::string_view id) const {
    const auto shown = collections_for(context.is_operator);
    const auto found = std::ranges::find(shown, id, &Collection::id);
    return found == shown.end() ? nullptr : *found;
}

std::string FeaturesApi::collection_text(const ApiContext& context, const Collection& described) {
    const auto& id = described.id;
    const auto extent = extent_.get(context.version, [&] {
        return Extent{context.store.map_box(), context.store.seen()};
    });
    const auto& [west, south, east, north] = extent->box;
    const auto here = fmt::format("{}/collections/{}", context.base, id);
    std::vector<ApiLink> links{
        {here, "self", "application/json"},
        {here + "/items", "items", geojson_type},
        {here + "/items?f=html", "items", "text/html"},
        {here + "/queryables", "http://www.opengis.net/def/rel/ogc/1.0/queryables", schema_type}};
    if (id == "segments") {
        links.push_back({here + "/tiles",
                         "http://www.opengis.net/def/rel/ogc/1.0/tilesets-vector",
                         "application/json"});
    }
    JsonObject collection;
    collection.add("id", std::string{id})
        .add("title", std::string{described.title})
        .add("description", std::string{described.description})
        .add("attribution", context.store.settings().attribution)
        .add("itemType", "feature")
        .add("extent",
             JsonRaw{
                 fmt::format(R"({{"spatial":{{"bbox":[[{:.7f},{:.7f},{:.7f},{:.7f}]],"crs":"{}"}},)"
                             R"("temporal":{{"interval":[[{},{}]]}}}})",
                             west,
                             south,
                             east,
                             north,
                             uri_of(CoordinateReference::crs84),
                             day_json(extent->seen.first_ms),
                             day_json(extent->seen.last_ms))})
        .add("crs",
             JsonRaw{json_string_array(
                 {coordinate_reference_uris.begin(), coordinate_reference_uris.end()})})
        .add("storageCrs", std::string{uri_of(CoordinateReference::crs84)})
        .add("links", JsonRaw{links_text(links)});
    return collection.text();
}

HttpResponse FeaturesApi::collections(const ApiContext& context) {
    expect_parameters(context.request);
    std::vector<std::string> texts;
    for (const auto* const collection : collections_for(context.is_operator)) {
        texts.push_back(collection_text(context, *collection));
    }
    JsonObject page;
    page.add(
            "links",
            JsonRaw{links_text({{context.base + "/collections", "self", "application/json"},
                                {context.base + "/collections?f=html", "alternate", "text/html"}})})
        .add("crs",
             JsonRaw{json_string_array(
                 {coordinate_reference_uris.begin(), coordinate_reference_uris.end()})})
        .add("collections", JsonRaw{json_array(texts)});
    return for_its_reader(context, api_page(context, "Collections", page.text()));
}

HttpResponse FeaturesApi::collection(const ApiContext& context, std::string_view id) {
    expect_parameters(context.request);
    const auto* const found = find(context, id);
    return found == nullptr ? no_collection(id)
                            : for_its_reader(context,
                                             api_page(context,
                                                      std::string{found->title},
                                                      collection_text(context, *found)));
}

HttpResponse FeaturesApi::queryables(const ApiContext& context, std::string_view id) const {
    expect_parameters(context.request);
    const auto* const found = find(context, id);
    return found == nullptr
               ? no_collection(id)
               : api_page(
                     context,
                     std::string{found->title},
                     queryables_text(found->title,
                                     fmt::format("{}/collections/{}/queryables", context.base, id),
                                     found->columns(),
                                     found->geometry),
                     schema_type);
}

// -------------------------------------------------------------------------------------- items

HttpResponse FeaturesApi::items(const ApiContext& context, std::string_view id) {
    const auto* const found = find(context, id);
    return found == nullptr   ? no_collection(id)
           : id == "segments" ? segment_items(context, *found)
                              : list_items(context, *found);
}

HttpResponse FeaturesApi::segment_items(const ApiContext& context, const Collection& collection) {
    const auto& columns = collection.columns();
    const auto query = parse_items_query(context.request, columns);
    expect_known_period(context.store, query);
    const auto keys = selections_.keys(context.store, context.version, query);
    auto first = std::min(query.offset, keys->size());
    if (query.after) {
        const auto after = parse_segment_key(*query.after);
        first = static_cast<std::size_t>(std::ranges::upper_bound(*keys, after) - keys->begin());
    }
    const auto count = std::min(query.limit, keys->size() - first);
    const auto shown = std::span{*keys}.subspan(first, count);
    auto filter = filter_of(query);
    filter.box.reset(); // the keys are those of its segments
    filter.ranges = ranges_of(shown);
    Page page;
    page.matched = keys->size();
    const auto& classes = *class_table(context.store.settings().class_table);
    context.store.visit(filter, [&](const SegmentRecord& record) {
        const ClassedSegment row{record, classes};
        add_feature(page,
                    {.id = name_of(record.segment.key), .line = record.segment.line, .row = &row},
                    columns,
                    query);
    });
    if (first + count < keys->size()) {
        page.next = "after=" + percent_encoded(name_of(shown.back()));
    }
    return page_response(context, collection.id, query, std::move(page));
}

FeatureList FeaturesApi::sections(const StoreReader& store) const {
    try {
        return section_features(store, *sections_options_);
    } catch (const InputError& error) {
        if (std::string_view{error.what()}.starts_with(store.file().string())) {
            throw;
        }
        throw std::runtime_error{error.what()}; // it names a file of the operator, for him alone
    }
}

std::shared_ptr<const FeatureList> FeaturesApi::list(const ApiContext& context,
                                                     std::string_view id) {
    const auto& store = context.store;
    return id == "worst"      ? worst_.get(context.version, [&] { return worst_features(store); })
           : id == "sections" ? sections_.get(context.version, [&] { return sections(store); })
           : id == "trips"
               ? trips_.get(context.trips_version, [&] { return trip_features(store.file()); })
               : events_.get(context.version, [&] { return event_features(store); });
}

HttpResponse FeaturesApi::list_items(const ApiContext& context, const Collection& collection) {
    const auto& columns = collection.columns();
    const auto query = parse_items_query(context.request, columns);
    if (query.after) {
        throw UsageError{"after is for segments; pages of this collection have an offset"};
    }
    const auto all = list(context, collection.id);
    const auto area = query.box ? std::optional{area_of(*query.box)} : std::nullopt;
    Page page;
    TimeLimit limit;
    for (const auto& feature : all->features) {
        limit.check();
        const bool fits =
            (!area || (!feature.line.empty() && area->intersects(feature.line))) &&
            (!query.period || is_seen_in(feature, columns, *query.period)) &&
            std::ranges::all_of(query.tests, [&](const auto& test) { return test(feature); });
        if (fits && page.matched++ >= query.offset && page.returned < query.limit) {
            add_feature(page, feature, columns, query);
        }
    }
    if (query.offset + page.returned < page.matched && page.returned > 0) {
        page.next = fmt::format("offset={}", query.offset + page.returned);
    }
    return page_response(context, collection.id, query, std::move(page));
}

HttpResponse
FeaturesApi::item(const ApiContext& context, std::string_view id, const std::string& feature_id) {
    expect_parameters(context.request, {"crs"});
    const auto crs = parse_crs(context.request);
    const auto* const collection = find(context, id);
    if (collection == nullptr) {
        return no_collection(id);
    }
    if (id != "segments") {
        const auto all = list(context, id);
        const auto found = std::ranges::find(all->features, feature_id, &Feature::id);
        return found == all->features.end() ? no_feature(feature_id)
                                            : feature_response(context, *collection, *found, crs);
    }
    SegmentFilter filter;
    try {
        filter.key = parse_segment_key(feature_id);
    } catch (const InputError&) {
        return no_feature(feature_id);
    }
    auto response = no_feature(feature_id);
    const auto& classes = *class_table(context.store.settings().class_table);
    context.store.visit(filter, [&](const SegmentRecord& record) {
        const ClassedSegment row{record, classes};
        response = feature_response(
            context,
            *collection,
            {.id = name_of(record.segment.key), .line = record.segment.line, .row = &row},
            crs);
    });
    return response;
}

} // namespace macadam
