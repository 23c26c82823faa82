#include "rules.hpp"
#include "targets.hpp"

#include "app/cli/arguments.hpp"
#include "app/http/request_check.hpp"
#include "app/serve/filters/cql2_json.hpp"
#include "app/serve/filters/cql2_text.hpp"
#include "app/serve/filters/feature_filter.hpp"
#include "app/serve/ogc/items_query.hpp"
#include "storage/text/columns.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace macadam::fuzz {
namespace {

struct Road {
    std::optional<std::string> name, last_seen;
    std::optional<double> iri;
};

const std::vector<FeatureColumn>& road_columns() {
    static const Columns<Road> columns{
        {"name", as::text, [](auto& road) { return road.name; }},
        {"iri", as::iri(3), [](auto& road) { return road.iri; }},
        {"last_seen", as::day, [](auto& road) { return road.last_seen; }},
    };
    static const auto erased = feature_columns(columns);
    return erased;
}

} // namespace

Answer cql2_filter(std::string_view input) {
    static const std::vector<Road> roads{{"Haupt%straße", "2026-05-20", 4.25}, {}};
    static const std::vector<GeoPoint> line{{50, 10}, {50, 179.9}, {50, -179.9}};
    return may_refuse<Cql2Error>([&] {
        const auto expression =
            input.starts_with('{') ? parse_cql2_json(input) : parse_cql2_text(input);
        const auto filter =
            feature_filter(expression, road_columns(), CoordinateReference::epsg_4326);
        for (const auto& road : roads) {
            const Feature feature{.id = "1", .line = line, .row = &road};
            const bool passes = filter.test(feature);
            expect(passes == filter.test(feature), "a filter says the same twice");
            const auto denied = feature_filter({.op = "not", .args = {expression}, .literal = {}},
                                               road_columns(),
                                               CoordinateReference::epsg_4326);
            expect(!(passes && denied.test(feature)),
                   "no feature passes a filter and its contrary");
        }
    });
}

Answer http_request(std::string_view input) {
    RequestHead head{.method = "GET", .target = {}, .headers = {{"Host", "localhost"}}};
    head.target = input.substr(0, input.find('\n'));
    auto rest = input.substr(std::min(head.target.size() + 1, input.size()));
    while (!rest.empty()) {
        const auto header = rest.substr(0, rest.find('\n'));
        rest.remove_prefix(std::min(header.size() + 1, rest.size()));
        const auto colon = std::min(header.find(':'), header.size());
        head.headers.emplace_back(header.substr(0, colon),
                                  header.substr(std::min(colon + 1, header.size())));
    }
    HttpRequest request;
    if (const auto refusal = decode_head(head, HttpServerConfig{}, request)) {
        expect(refusal->status >= 400 && refusal->status < 500, "a refusal is of the client");
        return Answer::refused;
    }
    expect(request.path.starts_with('/') && request.path.find('\0') == std::string::npos,
           "a path is absolute text");
    return may_refuse<UsageError>([&] {
        const auto query = parse_items_query(request, road_columns());
        expect(query.limit >= 1 && query.limit <= max_limit, "a page has a size");
        expect(!query.box || !is_empty(*query.box), "a box that is taken holds a place");
    });
}

} // namespace macadam::fuzz
