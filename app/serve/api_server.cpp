#include "app/serve/api_server.hpp"

#include "app/http/static_folder.hpp"
#include "app/serve/api_routes.hpp"
#include "app/serve/live/live_content.hpp"
#include "app/serve/live/picture_tiles.hpp"
#include "app/serve/ogc/collections.hpp"
#include "app/serve/ogc/features_api.hpp"
#include "app/serve/ogc/tiles_api.hpp"
#include "app/serve/queue/queue_page.hpp"
#include "app/serve/queue/queue_watch.hpp"
#include "app/serve/served_store.hpp"
#include "app/serve/server_health.hpp"
#include "app/serve/server_metrics.hpp"
#include "app/serve/trips/server_uploads.hpp"
#include "app/serve/trips/trips_api.hpp"
#include "app/uploads/upload_workers.hpp"
#include "estimator/common/error.hpp"
#include "storage/text/utc.hpp"
#include "storage/uploads/upload_database.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>

namespace macadam {
namespace {

using namespace std::chrono_literals;

/// Time for requests at work when the server is told to stop; a command has 1.5 s to end
/// (InterruptHandler).
constexpr auto drain_time = 900ms;

constexpr std::uint64_t max_trip_bytes = 64U << 20U; // four hours of a phone at 60 Hz

// -------------------------------------------------------------------------------------- lanes

/// Workers that wait for pictures, which one thread draws, and those that write to a disk: neither
/// holds up those who read.
constexpr HttpLane drawing_workers{.workers = 8, .max_waiting = 64};
constexpr HttpLane storing_workers{.workers = 2, .max_waiting = 256};

/// Workers that select features, which can take 10 s: tiles and pages never wait for them, nor does
/// anybody for more than a few requests of one client.
HttpLane selecting_workers(std::size_t count) {
    return {.workers = count, .max_waiting = 256, .max_per_client = 8};
}

/// Tests for a path of features, or of what is computed from all of them.
bool is_path_of_features(std::string_view path) {
    return (path == "/collections" || path.starts_with("/collections/")) &&
           !path.starts_with("/collections/segments/tiles");
}

std::size_t lane_of(const HttpRequest& request) {
    constexpr std::size_t of_all = 0, of_drawing = 1, of_storing = 2, of_selecting = 3;
    const bool writes = request.method != "GET" && request.method != "HEAD";
    return writes                              ? of_storing
           : is_for_picture_tile(request)      ? of_drawing
           : is_path_of_features(request.path) ? of_selecting
                                               : of_all;
}

std::size_t count_workers(const HttpServerConfig& config) {
    auto count = config.workers;
    for (const auto& lane : config.lanes) {
        count += lane.workers;
    }
    return count;
}

// -------------------------------------------------------------------------------------- server

/// Returns the address under which a client sees this server.
std::string base_of(const HttpRequest& request, const ServedAddress& address) {
    return address.base.empty() ? fmt::format("http://{}", request.header("host")) : address.base;
}

bool reads(const HttpRequest& request) {
    return request.method == "GET" || request.method == "HEAD";
}

bool is_usual_method(std::string_view method) {
    constexpr std::array<std::string_view, 5> usual{"GET", "HEAD", "PUT", "POST", "DELETE"};
    return std::ranges::find(usual, method) != usual.end();
}

void log_request(const HttpRecord& record) {
    const auto now = std::chrono::duration_cast<std::chrono::milliseconds>(
        std::chrono::system_clock::now().time_since_epoch());
    print(fmt::format("{} {} {} {} {} B {:.1f} ms\n",
                      utc_text(now.count()),
                      is_usual_method(record.method) ? record.method : "-",
                      record.route,
                      record.status,
                      record.bytes,
                      static_cast<double>(record.duration.count()) / 1e3));
    flush_results();
}

/// Handlers that count and log, and answer /health and /metrics.
/// \param queue  null: there is none
HttpHandlers common_handlers(ServerMetrics& metrics,
                             QueueWatch* queue,
                             const ServerHealth& health,
                             const std::atomic<const HttpServer*>& server,
                             const ServedAddress& address,
                             const Console& console) {
    HttpHandlers handlers;
    handlers.answer_at_once = [&,
                               queue](const HttpRequest& request) -> std::optional<HttpResponse> {
        if (!reads(request)) {
            return std::nullopt;
        }
        if (request.path == "/health") {
            return health.response();
        }
        if (request.path == "/metrics") {
            const auto* const running = server.load(); // null while it starts
            return HttpResponse{.type = "text/plain; version=0.0.4",
                                .body =
                                    metrics.text(running == nullptr ? 0 : running->connections()) +
                                    (queue == nullptr ? "" : queue->metrics()),
                                .cache_control = "no-store",
                                .route = "/metrics"};
        }
        return std::nullopt;
    };
    handlers.record =
        [&, logs = address.has_access_log, has_warned = false](const HttpRecord& record) mutable {
            metrics.add(record);
            try {
                if (logs) {
                    log_request(record);
                }
            } catch (const InputError& error) { // its disk is full, or its reader has gone
                if (!std::exchange(has_warned, true)) {
                    console.warn(fmt::format("the access log has gaps: {}", error.what()));
                }
            }
        };
    handlers.failed = [&](const std::string& /*path*/, const std::string& what) {
        console.warn(fmt::format("a request failed: {}", what));
    };
    return handlers;
}

/// Keeps caches of several clients from handing on what only holders of a token may see.
void keep_private(HttpResponse& response) {
    constexpr std::string_view shared = "public";
    if (response.cache_control.starts_with(shared)) {
        response.cache_control.replace(0, shared.size(), "private");
    }
}

/// Admits what has a path of trips by its rules; else only what reads.
HttpAdmission admitted(TripsApi& trips, const HttpRequest& request, bool only_with_token) {
    if (TripsApi::has_path(request.path)) {
        return trips.admit(request);
    }
    if (reads(request)) {
        using Readers = TripsApi::Readers;
        if (is_path_of_operator(request.path) || is_path_of_queue(request.path)) {
            return {.refusal = trips.refused_reading(request, Readers::operator_)};
        }
        const bool is_open = !only_with_token || is_path_of_recorder(request.path);
        return {.refusal =
                    is_open ? std::nullopt : trips.refused_reading(request, Readers::with_token)};
    }
    auto refusal = http_problem(405, "expected GET or HEAD");
    refusal.headers.emplace_back("Allow", "GET, HEAD");
    return {.refusal = std::move(refusal)};
}

/// Finds where the database has its tokens and uploads; null if it has none.
/// \throws InputError  if only tokens let somebody read, and there can be none.
std::unique_ptr<UploadPlace> upload_place(const std::filesystem::path& file,
                                          const TripReception& reception) {
    const bool is_for_staff = !reception.staff_header.empty(); // who use it without a token
    if (reception.server.empty()) {
        if (is_for_staff) {
            make_uploads_folder(file);
        }
        return uploads_beside(file);
    }
    auto place = uploads_on_server(reception.server, is_for_staff);
    if (!place && (reception.only_with_token || is_for_staff)) {
        throw InputError{fmt::format("{}: the role may not read tokens, expected a member of "
                                     "macadam_importer or macadam_operator",
                                     reception.server)};
    }
    return place;
}

/// Waits a second, or until a stop is requested.
void wait_for_stop(const std::stop_token& stop) {
    std::mutex mutex;
    std::unique_lock lock{mutex};
    std::condition_variable_any stopped;
    stopped.wait_for(lock, stop, 1s, [] { return false; });
}

} // namespace

void serve_database(const std::filesystem::path& file,
                    Audience audience,
                    const HttpServerConfig& asked,
                    const ServedAddress& address,
                    const Console& console,
                    const std::function<void(std::uint16_t port)>& started,
                    const TripReception& reception,
                    const std::optional<SectionOptions>& sections,
                    const SiteLook& look) {
    auto config = asked;
    config.max_body_bytes = max_trip_bytes;
    config.lanes = {drawing_workers, storing_workers, selecting_workers(config.workers)};
    std::stop_source interruption; // of reading, once the time to drain is over
    ServedStore store{file, audience, count_workers(config), interruption.get_token()};
    LiveContent live{file, audience, console, look};
    PictureTiles pictures{file, audience, console, look.left_hand};
    const bool has_queue = !reception.server.empty();
    Pages pages{.features = FeaturesApi{sections},
                .live = live,
                .pictures = pictures,
                .has_queue = has_queue};
    Pages of_operator{.features = FeaturesApi{sections}, .live = live, .pictures = pictures};
    ServerMetrics metrics;
    std::atomic<const HttpServer*> running = nullptr;
    UploadWorkers workers{{.store = file, .arguments = upload_arguments(reception.import_words)},
                          reception.server.empty() ? reception.workers : 0,
                          console};
    TripsApi trips{
        upload_place(file, reception),
        {.base = address.base, .staff_header = reception.staff_header},
        [&] { workers.wake(); },
        [&](const std::string& why) { console.warn(fmt::format("a request failed: {}", why)); }};
    const auto follow = [&] {
        live.refresh(store.version(), store.shows_published_alone());
        trips.set_crowd(store.shows_published_alone());
    };
    follow();
    std::optional<QueueWatch> queue;
    if (has_queue) {
        queue.emplace(reception.server, console);
    }
    auto* const queue_or_none = queue ? &*queue : nullptr;
    ServerHealth health;
    auto handlers = common_handlers(metrics, queue_or_none, health, running, address, console);
    handlers.admit = [&](const HttpRequest& request) {
        return admitted(trips, request, reception.only_with_token);
    };
    handlers.lane = lane_of;
    handlers.is_public = [](const HttpRequest& request) {
        return !TripsApi::has_path(request.path) && !is_path_of_queue(request.path);
    };
    handlers.answer = [&](const HttpRequest& request, std::size_t worker) {
        if (TripsApi::has_path(request.path)) {
            return trips.answer(request);
        }
        if (is_path_of_queue(request.path)) {
            return queue_response(request, queue_or_none);
        }
        const bool is_operator =
            request.path.starts_with("/collections") && trips.is_of_operator(request);
        const auto reader = is_operator ? Audience::operator_ : Audience::anyone;
        const auto version = store.version(reader);
        try {
            auto response = answer_reading(is_operator ? of_operator : pages,
                                           {.request = request,
                                            .store = store.reader(worker, reader),
                                            .version = version,
                                            .base = base_of(request, address),
                                            .is_operator = is_operator,
                                            .trips_version = store.trips_version()});
            if (reception.only_with_token) {
                keep_private(response);
            }
            return response;
        } catch (const InputError& error) {
            console.warn(fmt::format("a request failed: {}", error.what()));
            return http_problem(503, "the database cannot be read now");
        }
    };
    HttpServer server{config, std::move(handlers)};
    running = &server;
    started(server.port());
    const auto prepare = [&](const StoreReader& reader, const std::string& version) {
        pages.features.prepare(reader, version);
    };
    std::string trouble;
    while (!console.stop().stop_requested()) {
        wait_for_stop(console.stop());
        try {
            if (store.look(prepare)) {
                console.detail("the database has changed");
                follow();
            }
            trouble.clear();
            health.warn("");
        } catch (const InputError& error) { // replaced or locked: what was read before stays
            health.warn("the database cannot be read now; the server shows what it read before");
            if (std::exchange(trouble, error.what()) != error.what()) {
                console.warn(error.what());
            }
        }
    }
    workers.request_stop();
    server.drain(drain_time);
    interruption.request_stop();
    pictures.request_stop();
}

void serve_folder(const std::filesystem::path& folder,
                  const HttpServerConfig& config,
                  const ServedAddress& address,
                  const Console& console,
                  const std::function<void(std::uint16_t port)>& started) {
    ServerMetrics metrics;
    std::atomic<const HttpServer*> running = nullptr;
    const ServerHealth health;
    auto handlers = common_handlers(metrics, nullptr, health, running, address, console);
    handlers.answer = [&](const HttpRequest& request, std::size_t) {
        return file_response(folder, request.path)
            .value_or(http_problem(404, "there is no such file"));
    };
    HttpServer server{config, std::move(handlers)};
    running = &server;
    started(server.port());
    while (!console.stop().stop_requested()) {
        wait_for_stop(console.stop());
    }
    server.drain(drain_time);
}

} // namespace macadam
