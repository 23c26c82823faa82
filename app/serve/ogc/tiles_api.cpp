#include "app/serve/ogc/tiles_api.hpp"

#include "app/cli/arguments.hpp"
#include "storage/text/json.hpp"
#include "storage/text/text.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string_view>

namespace macadam {
namespace {

constexpr std::string_view quad = "WebMercatorQuad";
constexpr std::string_view quad_uri =
    "http://www.opengis.net/def/tilematrixset/OGC/1.0/WebMercatorQuad";
constexpr std::string_view mercator_uri = "http://www.opengis.net/def/crs/EPSG/0/3857";
constexpr std::string_view vector_type = "application/vnd.mapbox-vector-tile";
constexpr std::string_view picture_type = "image/png";

HttpResponse not_ready() {
    auto response = http_problem(503, "the tiles are being made");
    response.headers.emplace_back("Retry-After", "2");
    return response;
}

HttpResponse busy_drawing() {
    auto response = http_problem(503, "the picture cannot be drawn now");
    response.headers.emplace_back("Retry-After", "2");
    return response;
}

HttpResponse no_matrix_set() {
    return http_problem(404, "there is no such tile matrix set, expected WebMercatorQuad");
}

std::optional<std::uint32_t> parse_number(std::string_view text) {
    std::uint32_t number = 0;
    const auto* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, number);
    return error == std::errc{} && stop == end ? std::optional{number} : std::nullopt;
}

/// Tests for the path of picture tiles.
bool is_of_pictures(const HttpRequest& request) {
    return request.path.starts_with("/map/");
}

/// Parses zoom, row and column; `std::nullopt` for what is no tile of the matrices.
std::optional<TileId> parse_tile(const std::vector<std::string>& zoom_row_column) {
    const auto zoom = parse_number(zoom_row_column[0]);
    const auto row = parse_number(zoom_row_column[1]);
    const auto column = parse_number(zoom_row_column[2]);
    const bool is_there = zoom && row && column && *zoom <= TileSet::max_zoom &&
                          *row < (1U << *zoom) && *column < (1U << *zoom);
    return is_there ? std::optional{TileId{static_cast<std::uint8_t>(*zoom), *column, *row}}
                    : std::nullopt;
}

/// Address of the tile sets that a request asks for: of the dataset or of a collection.
std::string tiles_address(const ApiContext& context) {
    const auto& path = context.request.path;
    return context.base + path.substr(0, path.find("/tiles") + std::string_view{"/tiles"}.size());
}

std::string template_of(const ApiContext& context, const TileSet& tiles, std::string_view order) {
    return fmt::format("{}/{}/{}?v={}", tiles_address(context), quad, order, tiles.version());
}

std::string tile_set_text(const ApiContext& context, const TileSet& tiles) {
    const auto here = fmt::format("{}/{}", tiles_address(context), quad);
    const auto& [west, south, east, north] = tiles.box();
    JsonObject set;
    set.add("title", context.store.file().stem().string())
        .add("dataType", is_of_pictures(context.request) ? "map" : "vector")
        .add("crs", std::string{mercator_uri})
        .add("tileMatrixSetURI", std::string{quad_uri})
        .add("boundingBox",
             JsonRaw{fmt::format(
                 R"({{"lowerLeft":[{:.7f},{:.7f}],"upperRight":[{:.7f},{:.7f}],"crs":"{}"}})",
                 west,
                 south,
                 east,
                 north,
                 "http://www.opengis.net/def/crs/OGC/1.3/CRS84")})
        .add("links",
             JsonRaw{links_text(
                 {{here, "self", "application/json"},
                  {fmt::format("{}/tileMatrixSets/{}", context.base, quad),
                   "http://www.opengis.net/def/rel/ogc/1.0/tiling-scheme",
                   "application/json"},
                  {context.base + "/tiles.json", "describedby", "application/json", "TileJSON"}})});
    // The template is a link with a member that others have not.
    auto text = set.text();
    text.insert(
        text.size() - 2,
        fmt::format(R"(,{{"href":{},"rel":"item","type":"{}","templated":true}})",
                    json_text(template_of(context, tiles, "{tileMatrix}/{tileRow}/{tileCol}")),
                    is_of_pictures(context.request) ? picture_type : vector_type));
    return text;
}

} // namespace

HttpResponse tile_sets_page(const ApiContext& context, const TileSet* tiles) {
    expect_parameters(context.request);
    if (tiles == nullptr) {
        return not_ready();
    }
    JsonObject page;
    page.add("links", JsonRaw{links_text({{tiles_address(context), "self", "application/json"}})})
        .add("tilesets", JsonRaw{json_array({tile_set_text(context, *tiles)})});
    return api_page(context, "Tiles", page.text());
}

HttpResponse
tile_set_page(const ApiContext& context, const TileSet* tiles, const std::string& matrix_set) {
    expect_parameters(context.request);
    return matrix_set != quad ? no_matrix_set()
           : tiles == nullptr ? not_ready()
                              : api_page(context, "Tiles", tile_set_text(context, *tiles));
}

bool is_for_picture_tile(const HttpRequest& request) {
    constexpr std::string_view tiles = "/tiles/WebMercatorQuad/";
    return request.path.find(tiles) != std::string::npos &&
           (is_of_pictures(request) || request.parameter("f") == "png");
}

HttpResponse tile_response(const ApiContext& context,
                           const TileSet* tiles,
                           PictureTiles& pictures,
                           const std::string& matrix_set,
                           const std::vector<std::string>& zoom_row_column) {
    expect_parameters(context.request, {"v"});
    const bool is_picture = is_for_picture_tile(context.request);
    const std::string expected_format = is_of_pictures(context.request) ? "png" : "mvt or png";
    if (const auto format = context.request.parameter("f");
        format && *format != "png" && (*format != "mvt" || is_of_pictures(context.request))) {
        throw UsageError{fmt::format("f is {}, expected {}", in_quotes(*format), expected_format)};
    }
    if (matrix_set != quad) {
        return no_matrix_set();
    }
    const auto id = parse_tile(zoom_row_column);
    if (!id) {
        return http_problem(404,
                            fmt::format("there is no such tile, expected zoom 0 to {}, a row and a "
                                        "column of it",
                                        TileSet::max_zoom));
    }
    if (tiles == nullptr) {
        return not_ready();
    }
    const bool is_versioned = context.request.parameter("v") == tiles->version();
    HttpResponse response{
        .type = std::string{is_picture ? picture_type : vector_type},
        .etag = fmt::format(
            "{}-{}-{}-{}{}", tiles->version(), id->zoom, id->y, id->x, is_picture ? "-p" : ""),
        .cache_control = is_versioned ? "public, max-age=31536000, immutable" : "no-cache"};
    if (!is_picture) {
        if (auto bytes = tiles->tile(*id)) {
            response.body = *std::move(bytes);
            response.is_gzipped = true;
        } else {
            response.status = 204;
        }
        return response;
    }
    const auto picture = pictures.tile(tiles->version(), *id);
    if (!picture) {
        return busy_drawing();
    }
    if (*picture) {
        response.body = **picture;
    } else {
        response.status = 204;
    }
    return response;
}

HttpResponse tile_json_page(const ApiContext& context, const TileSet* tiles) {
    expect_parameters(context.request);
    if (tiles == nullptr) {
        return not_ready();
    }
    const auto& [west, south, east, north] = tiles->box();
    JsonObject page;
    page.add("tilejson", "3.0.0")
        .add("name", context.store.file().stem().string())
        .add("attribution", context.store.settings().attribution)
        .add("version", "1.0.0")
        .add("scheme", "xyz")
        .add("tiles",
             JsonRaw{json_string_array({fmt::format(
                 "{}/tiles/{}/{{z}}/{{y}}/{{x}}?v={}", context.base, quad, tiles->version())})})
        .add("minzoom", std::int64_t{TileSet::min_zoom})
        .add("maxzoom", std::int64_t{TileSet::max_zoom})
        .add("bounds",
             JsonRaw{fmt::format("[{:.7f},{:.7f},{:.7f},{:.7f}]", west, south, east, north)})
        .add("vector_layers", JsonRaw{tiles->layers()});
    return api_page(context, "TileJSON", page.text());
}

HttpResponse matrix_sets_page(const ApiContext& context) {
    expect_parameters(context.request);
    const auto links = links_text(
        {{fmt::format("{}/tileMatrixSets/{}", context.base, quad), "self", "application/json"}});
    return api_page(
        context,
        "Tile matrix sets",
        fmt::format(R"({{"tileMatrixSets":[{{"id":"{}","uri":"{}","crs":"{}","links":{}}}]}})",
                    quad,
                    quad_uri,
                    mercator_uri,
                    links));
}

HttpResponse matrix_set_page(const ApiContext& context, const std::string& matrix_set) {
    expect_parameters(context.request);
    if (matrix_set != quad) {
        return no_matrix_set();
    }
    constexpr double radius_m = 6378137, half_m = std::numbers::pi * radius_m;
    constexpr double pixel_m = 0.00028; // of a display, OGC 17-083r2, 6.1
    constexpr int tile_px = 256;
    std::vector<std::string> matrices;
    for (int zoom = TileSet::min_zoom; zoom <= TileSet::max_zoom; ++zoom) {
        const double cell_m = 2 * half_m / std::ldexp(tile_px, zoom);
        matrices.push_back(fmt::format(
            R"({{"id":"{}","scaleDenominator":{},"cellSize":{},"cornerOfOrigin":"topLeft",)"
            R"("pointOfOrigin":[{},{}],"tileWidth":{},"tileHeight":{},"matrixWidth":{},"matrixHeight":{}}})",
            zoom,
            cell_m / pixel_m,
            cell_m,
            -half_m,
            half_m,
            tile_px,
            tile_px,
            1U << static_cast<unsigned>(zoom),
            1U << static_cast<unsigned>(zoom)));
    }
    return api_page(
        context,
        std::string{quad},
        fmt::format(
            R"({{"id":"{}","title":"Google Maps Compatible for the World","uri":"{}","crs":"{}",)"
            R"("orderedAxes":["X","Y"],"wellKnownScaleSet":"http://www.opengis.net/def/wkss/OGC/1.0/GoogleMapsCompatible","tileMatrices":{}}})",
            quad,
            quad_uri,
            mercator_uri,
            json_array(matrices)));
}

} // namespace macadam
