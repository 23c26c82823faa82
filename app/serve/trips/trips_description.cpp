#include "app/serve/trips/trips_description.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

namespace macadam {
namespace {

constexpr std::string_view upload_schema =
    R"({"type":"object","required":["sha256","state"],"properties":{)"
    R"("sha256":{"type":"string","pattern":"^[0-9a-f]{64}$"},)"
    R"("state":{"type":"string","enum":["queued","working","imported","known","outside","refused","deleting"]},)"
    R"("received":{"type":"string","format":"date-time"},"bytes":{"type":"integer"},)"
    R"("trips":{"type":"integer"},"passes":{"type":"integer"},"reason":{"type":"string"}}})";

constexpr std::string_view queue_schema =
    R"({"type":"object","required":["read","queue"],"properties":{)"
    R"("read":{"type":"string","format":"date-time"},"queue":{"type":"object","required":[)"
    R"("logs","oldest_s","accepted_in_minute","accepted_in_hour","finished_in_minute",)"
    R"("finished_in_hour","passes_in_hour","chunks_to_fuse","objects","workers","failed"],)"
    R"("properties":{"logs":{"type":"object","additionalProperties":{"type":"integer"}},)"
    R"("oldest_s":{"type":"number"},"accepted_in_minute":{"type":"integer"},)"
    R"("accepted_in_hour":{"type":"integer"},"finished_in_minute":{"type":"integer"},)"
    R"("finished_in_hour":{"type":"integer"},"passes_in_hour":{"type":"integer"},)"
    R"("chunks_to_fuse":{"type":"integer"},"objects":{"type":"string","nullable":true},)"
    R"("workers":{"type":"array","items":{"type":"object"}},)"
    R"("failed":{"type":"array","items":{"type":"object"}}}}}})";

constexpr std::string_view sha256_parameter =
    R"({"name":"sha256","in":"path","required":true,"description":"SHA-256 of the bytes of the log",)"
    R"("schema":{"type":"string","pattern":"^[0-9a-f]{64}$"}})";

/// Response with a body, or without one for an empty schema.
std::string response_text(std::string_view description, std::string_view schema) {
    return schema.empty()
               ? fmt::format(R"({{"description":"{}"}})", description)
               : fmt::format(
                     R"({{"description":"{}","content":{{"application/json":{{"schema":{}}}}}}})",
                     description,
                     schema);
}

struct Operation {
    std::string_view id;
    std::string_view summary;
    std::string_view parameters{};
    std::string_view body{}; ///< member "requestBody" of the operation; "" = none
    std::vector<std::pair<int, std::string>> responses{};
    std::vector<int> problems{};
};

/// Response of a type, with the schema of a component.
std::string typed_response(std::string_view type, std::string_view component) {
    return fmt::format(
        R"({{"description":"OK","content":{{"{}":{{"schema":{{"$ref":"#/components/schemas/{}"}}}}}}}})",
        type,
        component);
}

std::string operation_text(const Operation& operation) {
    JsonObject responses;
    for (const auto& [status, text] : operation.responses) {
        responses.add(std::to_string(status), JsonRaw{text});
    }
    for (const int status : operation.problems) {
        responses.add(std::to_string(status),
                      JsonRaw{R"({"$ref":"#/components/responses/Problem"})"});
    }
    JsonObject object;
    object.add("operationId", std::string{operation.id})
        .add("summary", std::string{operation.summary})
        .add("security", JsonRaw{R"([{"bearer":[]},{"basic":[]}])"})
        .add("parameters", JsonRaw{fmt::format("[{}]", operation.parameters)});
    if (!operation.body.empty()) {
        object.add("requestBody", JsonRaw{std::string{operation.body}});
    }
    object.add("responses", JsonRaw{responses.text()});
    return object.text();
}

} // namespace

const std::string_view trip_security_schemes =
    R"({"bearer":{"type":"http","scheme":"bearer"},"basic":{"type":"http","scheme":"basic"}})";

void add_trip_collection_paths(JsonObject& paths, const std::vector<std::string>& of_items) {
    std::string parameters;
    for (const auto& parameter : of_items) {
        parameters += (parameters.empty() ? "" : ",") + parameter;
    }
    constexpr std::string_view here = "/collections/trips", geojson = "application/geo+json";
    constexpr std::string_view feature =
        R"({"name":"featureId","in":"path","required":true,"description":"SHA-256 of the trip","schema":{"type":"string"}})";
    const auto add = [&](std::string_view path,
                         std::string_view id,
                         std::string_view summary,
                         std::string_view its_parameters,
                         std::string response) {
        JsonObject object;
        object.add("get",
                   JsonRaw{operation_text({.id = id,
                                           .summary = summary,
                                           .parameters = its_parameters,
                                           .responses = {{200, std::move(response)}},
                                           .problems = {400, 401, 403, 404, 429, 503}})});
        paths.add(fmt::format("{}{}", here, path), JsonRaw{object.text()});
    };
    add("",
        "tripCollection",
        "Trips, without where they went; for tokens of scope operator",
        "",
        typed_response("application/json", "Linked"));
    add("/queryables",
        "tripQueryables",
        "Properties of trips for filters",
        "",
        R"({"description":"OK","content":{"application/schema+json":{"schema":{"type":"object"}}}})");
    add("/items", "tripItems", "Trips", parameters, typed_response(geojson, "FeatureCollection"));
    add("/items/{featureId}", "tripItem", "A trip", feature, typed_response(geojson, "Feature"));
}

void add_trip_paths(JsonObject& paths) {
    const auto list_schema = fmt::format(
        R"({{"type":"object","required":["trips"],"properties":{{"trips":{{"type":"array","items":{}}}}}}})",
        upload_schema);
    constexpr std::string_view log_body =
        R"({"required":true,"description":"A trip log or an archive of logs, as 'macadam import' reads them, at most 64 MiB",)"
        R"("content":{"text/csv":{"schema":{"type":"string","format":"binary"}},)"
        R"("application/gzip":{"schema":{"type":"string","format":"binary"}},)"
        R"("application/zstd":{"schema":{"type":"string","format":"binary"}},)"
        R"("application/zip":{"schema":{"type":"string","format":"binary"}},)"
        R"("application/x-tar":{"schema":{"type":"string","format":"binary"}}}})";
    JsonObject tokens;
    tokens.add(
        "post",
        JsonRaw{operation_text(
            {.id = "acceptInvitation",
             .summary = "Exchange an invitation, sent as a token, for a token; again within ten "
                        "minutes, for "
                        "another in its place",
             .responses =
                 {{201,
                   response_text(
                       "The token",
                       R"({"type":"object","required":["token"],"properties":{"token":{"type":"string"}}})")}},
             .problems = {400, 401, 404, 409, 429, 503}})});
    paths.add("/v1/tokens", JsonRaw{tokens.text()});
    JsonObject list;
    list.add("get",
             JsonRaw{operation_text({.id = "trips",
                                     .summary = "The latest 1000 uploads of the token's owner; of "
                                                "all for an operator",
                                     .responses = {{200, response_text("OK", list_schema)}},
                                     .problems = {400, 401, 403, 404, 429, 503}})});
    paths.add("/v1/trips", JsonRaw{list.text()});
    JsonObject one;
    one.add("put",
            JsonRaw{operation_text(
                {.id = "putTrip",
                 .summary = "Send a trip",
                 .parameters = sha256_parameter,
                 .body = log_body,
                 .responses = {{200, response_text("It is known", upload_schema)},
                               {202, response_text("It is on disk and waits", upload_schema)}},
                 .problems = {400, 401, 403, 404, 411, 413, 415, 422, 429, 503}})})
        .add("get",
             JsonRaw{operation_text({.id = "trip",
                                     .summary = "What became of an upload",
                                     .parameters = sha256_parameter,
                                     .responses = {{200, response_text("OK", upload_schema)}},
                                     .problems = {400, 401, 403, 404, 429, 503}})})
        .add("delete",
             JsonRaw{operation_text(
                 {.id = "deleteTrip",
                  .summary = "Take an upload back, with the trips that came of it",
                  .parameters = sha256_parameter,
                  .responses = {{202, response_text("It will be deleted", upload_schema)},
                                {204, response_text("It is gone", "")}},
                  .problems = {400, 401, 403, 404, 429, 503}})});
    paths.add("/v1/trips/{sha256}", JsonRaw{one.text()});
}

void add_queue_paths(JsonObject& paths) {
    const auto add = [&](std::string_view path, Operation operation) {
        operation.problems = {400, 401, 403, 404, 429, 503};
        JsonObject object;
        object.add("get", JsonRaw{operation_text(operation)});
        paths.add(path, JsonRaw{object.text()});
    };
    add("/queue/",
        {.id = "queuePage",
         .summary = "Page of the queue; for tokens of scope operator",
         .responses = {
             {200,
              R"({"description":"OK","content":{"text/html":{"schema":{"type":"string"}}}})"}}});
    add("/queue/status",
        {.id = "queueStatus",
         .summary = "State of the queue; for tokens of scope operator",
         .responses = {{200, response_text("OK", queue_schema)}}});
}

} // namespace macadam
