#include "app/serve/ogc/api_description.hpp"

#include "app/serve/features/feature.hpp"
#include "app/serve/ogc/items_query.hpp"
#include "app/serve/trips/trips_description.hpp"
#include "storage/text/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace macadam {
namespace {

constexpr std::string_view openapi_type = "application/vnd.oai.openapi+json;version=3.0";

// ------------------------------------------------------------------------- parameters of paths

/// Parameter of OpenAPI by its name, place and schema.
std::string parameter_text(std::string_view name,
                           std::string_view place,
                           std::string_view schema,
                           std::string_view description) {
    JsonObject parameter;
    parameter.add("name", std::string{name})
        .add("in", std::string{place})
        .add("required", place == "path")
        .add("description", std::string{description})
        .add("schema", JsonRaw{std::string{schema}});
    if (name == "bbox") {
        parameter.add("style", "form").add("explode", false);
    }
    return parameter.text();
}

constexpr std::string_view text_schema = R"({"type":"string"})";
constexpr std::string_view uri_schema = R"({"type":"string","format":"uri"})";

/// Parameters of .../items, with the columns of a collection.
std::vector<std::string> items_parameters(const Collection& collection) {
    std::vector<std::string> parameters{
        parameter_text("limit",
                       "query",
                       fmt::format(R"({{"type":"integer","minimum":1,"maximum":{},"default":{}}})",
                                   max_limit,
                                   default_limit),
                       "Features of a page; more are cut to the maximum"),
        parameter_text("offset",
                       "query",
                       R"({"type":"integer","minimum":0,"default":0})",
                       "Features to leave out"),
        parameter_text("after", "query", text_schema, "Id of the last feature of the page before"),
        parameter_text(
            "bbox",
            "query",
            R"({"type":"array","oneOf":[{"minItems":4,"maxItems":4},{"minItems":6,"maxItems":6}],"items":{"type":"number"}})",
            "West, south, east, north; west > east crosses the antimeridian"),
        parameter_text("bbox-crs", "query", uri_schema, "Coordinate reference system of bbox"),
        parameter_text("crs", "query", uri_schema, "Coordinate reference system of the answer"),
        parameter_text("datetime",
                       "query",
                       text_schema,
                       "Time or interval of the passes: 2026-05-01, 2026-03-01/.."),
        parameter_text(
            "filter", "query", text_schema, "Condition in CQL2: iri > 4 AND passes >= 3"),
        parameter_text(
            "filter-lang",
            "query",
            R"({"type":"string","enum":["cql2-text","cql2-json"],"default":"cql2-text"})",
            "Language of filter"),
        parameter_text("filter-crs", "query", uri_schema, "Coordinate reference system of filter"),
        parameter_text("f", "query", R"({"type":"string","enum":["json","html"]})", "Format")};
    for (const auto& column : collection.columns()) {
        const bool is_number = column.type.kind == ColumnType::Kind::integer ||
                               column.type.kind == ColumnType::Kind::real;
        parameters.push_back(parameter_text(column.name,
                                            "query",
                                            is_number ? R"({"type":"number"})" : text_schema,
                                            "Only features with this value"));
    }
    return parameters;
}

/// Schemas of the bodies, referred to by operations.
constexpr std::string_view schemas =
    R"({"Problem":{"type":"object","required":["title","status","detail"],"properties":{)"
    R"("title":{"type":"string"},"status":{"type":"integer"},"detail":{"type":"string"}}},)"
    R"("Link":{"type":"object","required":["href","rel","type"],"properties":{)"
    R"("href":{"type":"string"},"rel":{"type":"string"},"type":{"type":"string"}}},)"
    R"("Linked":{"type":"object","required":["links"],"properties":{)"
    R"("links":{"type":"array","items":{"$ref":"#/components/schemas/Link"}}}},)"
    R"("Feature":{"type":"object","required":["type","id","geometry","properties"],"properties":{)"
    R"("type":{"type":"string","enum":["Feature"]},"id":{"type":"string"},)"
    R"("geometry":{"type":"object","nullable":true,"required":["type","coordinates"]},)"
    R"("properties":{"type":"object"}}},)"
    R"("FeatureCollection":{"allOf":[{"$ref":"#/components/schemas/Linked"},{"type":"object",)"
    R"("required":["type","features","numberMatched","numberReturned"],"properties":{)"
    R"("type":{"type":"string","enum":["FeatureCollection"]},)"
    R"("features":{"type":"array","items":{"$ref":"#/components/schemas/Feature"}},)"
    R"("numberMatched":{"type":"integer","minimum":0},)"
    R"("numberReturned":{"type":"integer","minimum":0}}}]}})";

/// Schema of the body of an operation.
std::string_view schema_of(std::string_view id, std::string_view type) {
    constexpr std::array<std::string_view, 3> linked{"landing", "collections", "collection"};
    return id == "items"  ? R"({"$ref":"#/components/schemas/FeatureCollection"})"
           : id == "item" ? R"({"$ref":"#/components/schemas/Feature"})"
           : std::ranges::find(linked, id) != linked.end()
               ? R"({"$ref":"#/components/schemas/Linked"})"
           : type.find("json") == std::string_view::npos ? R"({"type":"string","format":"binary"})"
                                                         : R"({"type":"object"})";
}

/// Operation of one path that answers GET.
std::string operation_text(std::string_view id,
                           std::string_view summary,
                           std::string_view type,
                           const std::vector<std::string>& parameters) {
    JsonObject operation;
    operation.add("operationId", std::string{id})
        .add("summary", std::string{summary})
        .add("parameters", JsonRaw{json_array(parameters)})
        .add("responses",
             JsonRaw{fmt::format(
                 R"({{"200":{{"description":"OK","content":{{"{}":{{"schema":{}}}}}}},{})"
                 R"("400":{{"$ref":"#/components/responses/Problem"}},)"
                 R"("404":{{"$ref":"#/components/responses/Problem"}},)"
                 R"("429":{{"$ref":"#/components/responses/Problem"}},)"
                 R"("503":{{"$ref":"#/components/responses/Problem"}}}})",
                 type,
                 schema_of(id, type),
                 id.ends_with("getTile") ? R"("204":{"description":"An empty tile"},)" : "")});
    return fmt::format(R"({{"get":{}}})", operation.text());
}

std::string paths_text(const std::vector<const Collection*>& collections, bool has_queue) {
    const auto collection = [&] {
        std::vector<std::string> names;
        for (const auto* const each : collections) {
            names.emplace_back(each->id);
        }
        return parameter_text(
            "collectionId",
            "path",
            fmt::format(R"({{"type":"string","enum":{}}})", json_string_array(names)),
            "Collection");
    }();
    const auto feature = parameter_text("featureId", "path", text_schema, "Id of the feature");
    auto of_items = items_parameters(*collections.front());
    of_items.insert(of_items.begin(), collection);
    constexpr std::string_view json = "application/json", geojson = "application/geo+json";
    JsonObject paths;
    const auto add = [&](std::string_view path,
                         std::string_view id,
                         std::string_view summary,
                         std::string_view type,
                         const std::vector<std::string>& parameters = {}) {
        paths.add(path, JsonRaw{operation_text(id, summary, type, parameters)});
    };
    add("/", "landing", "Landing page", json);
    add("/conformance", "conformance", "Conformance classes", json);
    add("/api", "api", "This definition", openapi_type);
    add("/collections", "collections", "Collections", json);
    add("/collections/{collectionId}", "collection", "A collection", json, {collection});
    add("/collections/{collectionId}/queryables",
        "queryables",
        "Properties for filters",
        "application/schema+json",
        {collection});
    add("/collections/{collectionId}/items", "items", "Features", geojson, of_items);
    add("/collections/{collectionId}/items/{featureId}",
        "item",
        "A feature",
        geojson,
        {collection,
         feature,
         parameter_text("crs", "query", uri_schema, "Coordinate reference system")});
    const auto matrix_set = parameter_text(
        "tileMatrixSetId", "path", R"({"type":"string","enum":["WebMercatorQuad"]})", "Tiling");
    const auto of_tile = [&](std::string_view name) {
        return parameter_text(name, "path", R"({"type":"integer","minimum":0})", "Of the tile");
    };
    const std::vector<std::string> of_tile_set{
        matrix_set,
        of_tile("tileMatrix"),
        of_tile("tileRow"),
        of_tile("tileCol"),
        parameter_text("v", "query", text_schema, "Version; a tile of it never changes")};
    auto of_vector_tile = of_tile_set;
    of_vector_tile.push_back(
        parameter_text("f",
                       "query",
                       R"({"type":"string","enum":["mvt","png"],"default":"mvt"})",
                       "Vector or picture tile"));
    constexpr std::string_view of_set = "/{tileMatrixSetId}",
                               of_matrix = "/{tileMatrix}/{tileRow}/{tileCol}";
    struct Tiles {
        std::string_view place, name, type;
    };
    constexpr std::string_view mvt = "application/vnd.mapbox-vector-tile";
    for (const auto& [place, name, type] :
         {Tiles{"/tiles", "dataset.vector.", mvt},
          Tiles{"/collections/segments/tiles", "segments.vector.", mvt},
          Tiles{"/map/tiles", "dataset.map.", "image/png"}}) {
        add(place, fmt::format("{}getTileSetsList", name), "Tile sets", json);
        add(fmt::format("{}{}", place, of_set),
            fmt::format("{}getTileSet", name),
            "A tile set",
            json,
            {matrix_set});
        add(fmt::format("{}{}{}", place, of_set, of_matrix),
            fmt::format("{}getTile", name),
            "A tile",
            type,
            type == mvt ? of_vector_tile : of_tile_set);
    }
    add("/tileMatrixSets", "matrixSets", "Tile matrix sets", json);
    add("/tileMatrixSets/{tileMatrixSetId}", "matrixSet", "A tile matrix set", json, {matrix_set});
    add("/tiles.json", "tileJson", "TileJSON 3.0", json);
    add("/health", "health", "Whether the server is well", "application/health+json");
    add("/metrics", "metrics", "Counts for Prometheus", "text/plain");
    for (const auto& each : known_collections()) {
        if (each.is_of_operator) {
            add_trip_collection_paths(paths, items_parameters(each));
        }
    }
    add_trip_paths(paths);
    if (has_queue) {
        add_queue_paths(paths);
    }
    return paths.text();
}

} // namespace

HttpResponse landing_page(const ApiContext& context) {
    expect_parameters(context.request);
    const auto& base = context.base;
    JsonObject page;
    page.add("title", context.store.file().stem().string())
        .add("description", "Roughness of roads (IRI, mm/m), measured by ordinary cars; indicative")
        .add("attribution", context.store.settings().attribution)
        .add("links",
             JsonRaw{links_text(
                 {{base + "/?f=json", "self", "application/json", "This page"},
                  {base + "/?f=html", "alternate", "text/html", "This page as HTML"},
                  {base + "/api", "service-desc", openapi_type, "Definition of the API"},
                  {base + "/api?f=html", "service-doc", "text/html", "Definition, to read"},
                  {base + "/conformance", "conformance", "application/json", "Conformance"},
                  {base + "/collections", "data", "application/json", "Collections"},
                  {base + "/tiles",
                   "http://www.opengis.net/def/rel/ogc/1.0/tilesets-vector",
                   "application/json",
                   "Vector tiles"},
                  {base + "/map/tiles",
                   "http://www.opengis.net/def/rel/ogc/1.0/tilesets-map",
                   "application/json",
                   "Picture tiles"},
                  {base + "/tileMatrixSets",
                   "http://www.opengis.net/def/rel/ogc/1.0/tiling-schemes",
                   "application/json",
                   "Tile matrix sets"},
                  {base + "/tiles.json", "alternate", "application/json", "TileJSON"}})});
    return api_page(context, context.store.file().stem().string(), page.text());
}

HttpResponse conformance_page(const ApiContext& context) {
    expect_parameters(context.request);
    const std::vector<std::string> classes{
        "http://www.opengis.net/spec/ogcapi-common-1/1.0/conf/core",
        "http://www.opengis.net/spec/ogcapi-features-1/1.0/conf/core",
        "http://www.opengis.net/spec/ogcapi-features-1/1.0/conf/oas30",
        "http://www.opengis.net/spec/ogcapi-features-1/1.0/conf/geojson",
        "http://www.opengis.net/spec/ogcapi-features-1/1.0/conf/html",
        "http://www.opengis.net/spec/ogcapi-features-2/1.0/conf/crs",
        "http://www.opengis.net/spec/ogcapi-features-3/1.0/conf/queryables",
        "http://www.opengis.net/spec/ogcapi-features-3/1.0/conf/queryables-query-parameters",
        "http://www.opengis.net/spec/ogcapi-features-3/1.0/conf/filter",
        "http://www.opengis.net/spec/ogcapi-features-3/1.0/conf/features-filter",
        "http://www.opengis.net/spec/cql2/1.0/conf/cql2-text",
        "http://www.opengis.net/spec/cql2/1.0/conf/cql2-json",
        "http://www.opengis.net/spec/cql2/1.0/conf/basic-cql2",
        "http://www.opengis.net/spec/cql2/1.0/conf/advanced-comparison-operators",
        "http://www.opengis.net/spec/cql2/1.0/conf/case-insensitive-comparison",
        "http://www.opengis.net/spec/cql2/1.0/conf/basic-spatial-functions",
        "http://www.opengis.net/spec/cql2/1.0/conf/basic-spatial-functions-plus",
        "http://www.opengis.net/spec/cql2/1.0/conf/spatial-functions",
        "http://www.opengis.net/spec/cql2/1.0/conf/temporal-functions",
        "http://www.opengis.net/spec/cql2/1.0/conf/property-property",
        "http://www.opengis.net/spec/cql2/1.0/conf/arithmetic",
        "http://www.opengis.net/spec/ogcapi-tiles-1/1.0/conf/core",
        "http://www.opengis.net/spec/ogcapi-tiles-1/1.0/conf/tileset",
        "http://www.opengis.net/spec/ogcapi-tiles-1/1.0/conf/tilesets-list",
        "http://www.opengis.net/spec/ogcapi-tiles-1/1.0/conf/dataset-tilesets",
        "http://www.opengis.net/spec/ogcapi-tiles-1/1.0/conf/geodata-tilesets",
        "http://www.opengis.net/spec/ogcapi-tiles-1/1.0/conf/mvt",
        "http://www.opengis.net/spec/ogcapi-tiles-1/1.0/conf/png",
        "http://www.opengis.net/spec/tms/2.0/conf/tilematrixset"};
    JsonObject page;
    page.add("conformsTo", JsonRaw{json_string_array(classes)});
    return api_page(context, "Conformance", page.text());
}

HttpResponse openapi_page(const ApiContext& context,
                          const std::vector<const Collection*>& collections,
                          bool has_queue) {
    expect_parameters(context.request);
    const auto text = fmt::format(
        R"({{"openapi":"3.0.3","info":{{"title":{},"version":"{}","license":{{"name":{}}}}},)"
        R"("servers":[{{"url":"{}"}}],"paths":{},)"
        R"("components":{{"schemas":{},"securitySchemes":{},"responses":{{"Problem":{{"description":"Refused",)"
        R"("content":{{"application/problem+json":{{"schema":{{"$ref":"#/components/schemas/Problem"}}}}}}}}}}}}}})",
        json_text(context.store.file().stem().string()),
        "1",
        json_text(context.store.settings().attribution.empty()
                      ? "of the operator"
                      : context.store.settings().attribution),
        context.base,
        paths_text(collections, has_queue),
        schemas,
        trip_security_schemes);
    return api_page(context, "API", text, openapi_type);
}

} // namespace macadam
