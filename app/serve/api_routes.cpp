#include "app/serve/api_routes.hpp"

#include "app/cli/arguments.hpp"
#include "app/http/static_folder.hpp"
#include "app/serve/ogc/api_description.hpp"
#include "app/serve/ogc/per_version.hpp"
#include "app/serve/ogc/segment_selections.hpp"
#include "app/serve/ogc/tiles_api.hpp"
#include "app/site/site_page.hpp"
#include "estimator/common/error.hpp"

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace macadam {
namespace {

using PathWords = std::vector<std::string>;

/// Answers with the latest tiles, whose version is that of the page; null before the first.
template <typename Answer>
HttpResponse with_tiles(const Pages& pages, const ApiContext& context, const Answer& answer) {
    const auto tiles = pages.live.tiles();
    return answer(ApiContext{.request = context.request,
                             .store = context.store,
                             .version = tiles ? tiles->version() : context.version,
                             .base = context.base,
                             .is_operator = context.is_operator},
                  tiles.get());
}

HttpResponse tile_sets(Pages& pages, const ApiContext& context, const PathWords& /*words*/) {
    return with_tiles(pages, context, tile_sets_page);
}

HttpResponse tile_set(Pages& pages, const ApiContext& context, const PathWords& words) {
    return with_tiles(pages, context, [&](const ApiContext& of_tiles, const TileSet* tiles) {
        return tile_set_page(of_tiles, tiles, words[0]);
    });
}

HttpResponse tile(Pages& pages, const ApiContext& context, const PathWords& words) {
    return with_tiles(pages, context, [&](const ApiContext& of_tiles, const TileSet* tiles) {
        return tile_response(
            of_tiles, tiles, pages.pictures, words[0], {words[1], words[2], words[3]});
    });
}

HttpResponse tile_json(Pages& pages, const ApiContext& context, const PathWords& /*words*/) {
    return with_tiles(pages, context, tile_json_page);
}

/// Path of the API: words in braces stand for any.
struct Route {
    std::string_view pattern;
    HttpResponse (*answer)(Pages& pages, const ApiContext& context, const PathWords& words);
};

// clang-format off
constexpr std::array routes{
    Route{"/", [](Pages&, const ApiContext& c, const PathWords&) { return landing_page(c); }},
    Route{"/conformance", [](Pages&, const ApiContext& c, const PathWords&) { return conformance_page(c); }},
    Route{"/api", [](Pages& p, const ApiContext& c, const PathWords&) { return openapi_page(c, p.features.collections_for(false), p.has_queue); }},
    Route{"/collections", [](Pages& p, const ApiContext& c, const PathWords&) { return p.features.collections(c); }},
    Route{"/collections/{id}", [](Pages& p, const ApiContext& c, const PathWords& w) { return p.features.collection(c, w[0]); }},
    Route{"/collections/{id}/queryables", [](Pages& p, const ApiContext& c, const PathWords& w) { return p.features.queryables(c, w[0]); }},
    Route{"/collections/{id}/items", [](Pages& p, const ApiContext& c, const PathWords& w) { return p.features.items(c, w[0]); }},
    Route{"/collections/{id}/items/{feature}",
          [](Pages& p, const ApiContext& c, const PathWords& w) { return p.features.item(c, w[0], w[1]); }},
    Route{"/tileMatrixSets", [](Pages&, const ApiContext& c, const PathWords&) { return matrix_sets_page(c); }},
    Route{"/tileMatrixSets/{set}", [](Pages&, const ApiContext& c, const PathWords& w) { return matrix_set_page(c, w[0]); }},
    Route{"/tiles", tile_sets},
    Route{"/tiles/{set}", tile_set},
    Route{"/tiles/{set}/{z}/{row}/{column}", tile},
    Route{"/collections/segments/tiles", tile_sets},
    Route{"/collections/segments/tiles/{set}", tile_set},
    Route{"/collections/segments/tiles/{set}/{z}/{row}/{column}", tile},
    Route{"/map/tiles", tile_sets},
    Route{"/map/tiles/{set}", tile_set},
    Route{"/map/tiles/{set}/{z}/{row}/{column}", tile},
    Route{"/tiles.json", tile_json},
};
// clang-format on

/// Matches a path; `words` are what stands for the words in braces.
bool matches(std::string_view pattern, std::string_view path, PathWords& words) {
    words.clear();
    while (true) {
        const auto wanted = pattern.substr(0, pattern.find('/'));
        const auto given = path.substr(0, path.find('/'));
        if (wanted.starts_with('{')) {
            if (given.empty()) {
                return false;
            }
            words.emplace_back(given);
        } else if (wanted != given) {
            return false;
        }
        const bool pattern_ends = wanted.size() == pattern.size();
        if (pattern_ends || given.size() == path.size()) {
            return pattern_ends && given.size() == path.size();
        }
        pattern.remove_prefix(wanted.size() + 1);
        path.remove_prefix(given.size() + 1);
    }
}

/// Tests for a browser at the first page, which gets the map rather than the landing page.
bool wants_map(const HttpRequest& request) {
    const auto accept = request.header("accept");
    return request.path == "/" && !request.parameter("f") &&
           accept.find("text/html") < accept.find("json");
}

/// Returns a file of the page; of its data, which may be asked for by its version, none of another.
std::optional<HttpResponse> page_file(const LivePage& page, const HttpRequest& request) {
    const bool is_data = request.path.ends_with(".json"); // scripts have versions of their own
    const auto version = is_data ? request.parameter("v") : std::nullopt;
    if (version && *version != page.version) {
        return http_problem(410, "the map has changed since this page was opened");
    }
    auto response = file_response(page.place(), request.path);
    if (response && version) {
        response->cache_control = "public, max-age=31536000, immutable";
    }
    return response;
}

/// Returns a file of the recorder, which is there before the first map; `std::nullopt` if it is
/// none.
std::optional<HttpResponse> recorder_file(const std::string& path) {
    if (!is_path_of_recorder(path)) {
        return std::nullopt;
    }
    try {
        return file_response(site_page_folder(), path);
    } catch (const InputError&) { // this build has no page
        return std::nullopt;
    }
}

} // namespace

bool is_path_of_recorder(std::string_view path) {
    return path == "/drive" || path.starts_with("/drive/");
}

HttpResponse answer_reading(Pages& pages, const ApiContext& context) {
    if (const auto page = wants_map(context.request) ? pages.live.page() : nullptr) {
        if (auto response = file_response(page->place(), "/")) {
            response->headers.emplace_back("Vary", "Accept");
            return *std::move(response);
        }
    }
    PathWords words;
    for (const auto& [pattern, answer] : routes) {
        if (!matches(pattern, context.request.path, words)) {
            continue;
        }
        HttpResponse response;
        try {
            response = answer(pages, context, words);
        } catch (const UsageError& error) {
            response = http_problem(400, error.what());
        } catch (const SelectionTooLong&) {
            response = http_problem(503, "this selection takes too long; narrow it by bbox");
        } catch (const StillComputing&) {
            response = http_problem(503, "this is being computed");
            response.headers.emplace_back("Retry-After", "2");
        } catch (const InputError& error) {
            if (std::string_view{error.what()}.starts_with(context.store.file().string())) {
                throw; // of the database, for its operator alone
            }
            response = http_problem(400, error.what());
        }
        response.route = pattern;
        return response;
    }
    if (const auto page = pages.live.page()) {
        if (auto response = page_file(*page, context.request)) {
            return *std::move(response);
        }
    } else if (auto response = recorder_file(context.request.path)) {
        return *std::move(response);
    }
    return http_problem(404, "there is no such page");
}

} // namespace macadam
