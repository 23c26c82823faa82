#include "app/http/http_server.hpp"

#include "app/http/compressed_files.hpp"
#include "app/http/cross_origin.hpp"
#include "app/http/http_exchange.hpp"
#include "app/http/http_stream.hpp"
#include "app/http/limits/client_loads.hpp"
#include "app/http/limits/client_network.hpp"
#include "app/http/limits/connection_deadlines.hpp"
#include "app/http/limits/worker_lane.hpp"
#include "app/http/listening_socket.hpp"
#include "app/http/mhd_connection.hpp"
#include "app/http/request_check.hpp"
#include "app/http/response_finish.hpp"
#include "estimator/common/error.hpp"

#include <fmt/format.h>
#include <microhttpd.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <deque>
#include <exception>
#include <iterator>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <unistd.h>

namespace macadam {
namespace {

/// Bytes of responses that clients have not yet read; more are refused, whoever reads slowly.
constexpr std::uint64_t max_unread_bytes = 256U << 20U;

/// Answers of at most so many bytes are never refused for others that are not yet read: who
/// downloads a table goes on seeing the map.
constexpr std::uint64_t small_answer_bytes = 256U << 10U;

/// Bytes of a body that wait in memory until they are handed on.
constexpr std::size_t block_bytes = std::size_t{32} * 1024;

} // namespace

struct HttpServer::Impl final : MhdEvents {
    using Exchange = HttpExchange;
    using Clock = Exchange::Clock;

    Impl(HttpServerConfig its_config, HttpHandlers its_handlers)
        : config{std::move(its_config)}, handlers{std::move(its_handlers)} {
        const bool is_local = !config.unix_socket.empty();
        listening = is_local ? open_listening_socket(config.unix_socket)
                             : open_listening_socket(config.host, config.port);
        port = is_local ? 0 : port_of(listening);
        lanes.emplace_back(0, config.workers, config.max_waiting);
        auto workers = config.workers;
        for (const auto& lane : config.lanes) {
            lanes.emplace_back(workers, lane.workers, lane.max_waiting);
            workers += lane.workers;
        }
        lane_loads.resize(lanes.size());
        daemon = start_daemon(*this, listening, config);
        if (daemon == nullptr) {
            close(listening);
            throw InputError{is_local
                                 ? fmt::format("cannot serve on {}", config.unix_socket.string())
                                 : fmt::format("cannot serve on {} port {}", config.host, port)};
        }
    }

    ~Impl() override {
        drain(std::chrono::milliseconds{0});
        for (auto& lane : lanes) { // no connection stays suspended
            lane.stop();
        }
        MHD_stop_daemon(daemon);
        if (quiesced >= 0) {
            close(quiesced);
        }
    }

    // ------------------------------------------------------------------- thread of the network

    void connected(MHD_Connection* connection) override {
        ++connections;
        deadlines.set(socket_of(connection), config.head_time);
    }

    void disconnected(MHD_Connection* connection) override {
        --connections;
        deadlines.remove(socket_of(connection));
    }

    void* begun(const char* uri) override { return new Exchange{take_target(uri)}; }

    MHD_Result handle(MHD_Connection* connection,
                      const char* method,
                      std::string_view block,
                      void* request) override {
        auto& exchange = *static_cast<Exchange*>(request);
        if (exchange.is_done) {
            return queue_response(connection, exchange);
        }
        if (!exchange.is_begun) {
            if (!exchange.is_read && !has_body(connection)) {
                exchange.is_read = true; // a response before the next call would end the connection
                return MHD_YES;
            }
            exchange.is_begun = true;
            ++at_work;
            exchange.refusal = early_response(connection, method, exchange);
            if (exchange.body_bytes > 0) {
                set_body_deadline(connection, exchange);
                return MHD_YES;
            }
        } else if (!block.empty()) {
            receive(connection, exchange, block);
            return MHD_YES;
        }
        if (exchange.refusal) {
            answer(exchange, *std::move(exchange.refusal));
            return queue_response(connection, exchange);
        }
        hand_to_worker(connection, exchange, [this, connection, &exchange](std::size_t worker) {
            work_on(exchange, worker);
            exchange.is_done = true;
            MHD_resume_connection(connection);
        });
        return MHD_YES;
    }

    /// Takes a block of a body; that of a refused request is dropped, because a client that still
    /// sends would not see the answer. Blocks go to a worker, and the client waits meanwhile, so
    /// that a slow disk stalls nobody else and no body fills the memory.
    void receive(MHD_Connection* connection, Exchange& exchange, std::string_view block) {
        exchange.received_bytes += block.size();
        if (is_taken(exchange)) {
            exchange.pending += block;
        }
        if (exchange.pending.size() < block_bytes) {
            set_body_deadline(connection, exchange);
            return;
        }
        const auto begin = Clock::now();
        hand_to_worker(connection, exchange, [this, connection, &exchange, begin](std::size_t) {
            hand_on(exchange);
            exchange.handing_on += Clock::now() - begin;
            set_body_deadline(connection, exchange);
            MHD_resume_connection(connection);
        });
    }

    static bool is_taken(const Exchange& exchange) {
        return exchange.request.body && !exchange.refusal;
    }

    void set_body_deadline(MHD_Connection* connection, const Exchange& exchange) const {
        const auto slowest_bytes =
            is_taken(exchange) ? config.slowest_upload_bytes : config.slowest_bytes;
        const auto end =
            exchange.begin + config.body_time + exchange.handing_on +
            std::chrono::seconds{exchange.received_bytes / std::max<std::size_t>(slowest_bytes, 1)};
        deadlines.set(socket_of(connection), end - Clock::now());
    }

    /// Suspends a connection until a worker has done a job, which resumes it.
    template <typename Run>
    void hand_to_worker(MHD_Connection* connection, Exchange& exchange, Run run) {
        deadlines.suspend(socket_of(connection));
        MHD_suspend_connection(connection);
        const auto drop = [this, connection, &exchange] {
            answer(exchange, busy(503, "the server stops"));
            exchange.is_done = true;
            MHD_resume_connection(connection);
        };
        if (!lanes[exchange.lane].add({std::move(run), drop})) {
            drop();
        }
    }

    /// Returns the response to a request that no worker needs to see.
    std::optional<HttpResponse>
    early_response(MHD_Connection* connection, const char* method, Exchange& exchange) {
        const auto head = head_of(connection, method, exchange.target);
        exchange.request.client = client_network(peer_of(socket_of(connection)));
        if (auto refusal = decode_head(head, config, exchange.request)) {
            return refusal;
        }
        if (exchange.request.method == "OPTIONS") {
            return preflight_response(exchange.request);
        }
        if (handlers.answer_at_once) {
            if (auto answer = handlers.answer_at_once(exchange.request)) {
                return answer;
            }
        }
        if (handlers.admit) {
            auto admission = handlers.admit(exchange.request);
            const bool waits_for_leave = !exchange.request.header("expect").empty();
            if (!admission.refusal || !waits_for_leave) {
                exchange.body_bytes = body_bytes_of(exchange.request);
            }
            if (admission.refusal) {
                return std::move(admission.refusal);
            }
            exchange.request.body = std::move(admission.body);
        }
        if (handlers.lane) {
            exchange.lane = std::min(handlers.lane(exchange.request), lanes.size() - 1);
        }
        if (lanes[exchange.lane].is_full() || loads.unread_bytes() > max_unread_bytes) {
            return busy(503, "more is asked than this server can answer now");
        }
        if (!count_request(exchange)) {
            return busy(429, "too many requests of one address at once");
        }
        return std::nullopt;
    }

    /// Counts a request among those of its client. \returns false if they are too many. (A Unix
    /// socket tells nobody apart.)
    bool count_request(Exchange& exchange) {
        const auto& client = exchange.request.client;
        const auto most = exchange.lane == 0 ? 0 : config.lanes[exchange.lane - 1].max_per_client;
        if (most > 0 && !client.empty()) {
            exchange.is_in_lane = lane_loads[exchange.lane].add_request(client, most);
            if (!exchange.is_in_lane) {
                return false;
            }
        }
        exchange.is_counted =
            config.behind_proxy && loads.add_request(client, config.max_per_address);
        return exchange.is_counted || !config.behind_proxy;
    }

    /// Makes room in the lane of a request that no worker has any longer.
    void leave_lane(Exchange& exchange) {
        if (std::exchange(exchange.is_in_lane, false)) {
            lane_loads[exchange.lane].remove_request(exchange.request.client);
        }
    }

    bool is_public(const HttpRequest& request) const {
        return !handlers.is_public || handlers.is_public(request);
    }

    HttpResponse preflight_response(const HttpRequest& request) const {
        HttpResponse allowed{.status = 204, .cache_control = "no-store"};
        if (is_public(request)) {
            allowed.headers = preflight_headers(config.allowed_origins, request.header("origin"));
        }
        if (!allowed.headers.empty()) {
            return allowed;
        }
        auto refusal = http_problem(405, "expected GET or HEAD");
        refusal.headers.emplace_back("Allow", "GET, HEAD");
        return refusal;
    }

    static HttpResponse busy(int status, std::string_view words) {
        auto response = http_problem(status, words);
        response.headers.emplace_back("Retry-After", "1");
        return response;
    }

    /// Gives an exchange its response in the form in which it is sent.
    void answer(Exchange& exchange, HttpResponse response) {
        const auto& request = exchange.request;
        if ((request.method == "GET" || request.method == "HEAD") && is_public(request)) {
            std::ranges::move(
                cross_origin_headers(config.allowed_origins, request.header("origin")),
                std::back_inserter(response.headers));
        }
        exchange.route = response.route;
        exchange.response = finish(request, std::move(response), compressed_files);
    }

    static std::uint64_t content_bytes(const Exchange& exchange) {
        const auto& response = exchange.response;
        const bool has_content = exchange.request.method != "HEAD" && response.status != 304;
        return has_content ? response.part.size : 0;
    }

    /// Counts the bytes of a response that is kept in memory until it is read, or refuses it: who
    /// reads nothing shall take no room from others. (A Unix socket tells nobody apart.)
    void count_unread(Exchange& exchange) {
        const auto add = [this, &exchange] {
            const auto bytes = exchange.response.file ? 0 : content_bytes(exchange);
            const bool is_free = bytes <= small_answer_bytes || exchange.request.client.empty();
            const auto most =
                is_free ? std::numeric_limits<std::uint64_t>::max() : config.max_unread_per_address;
            const bool has_room = loads.add_unread(exchange.request.client, bytes, most);
            exchange.unread_bytes = has_room ? bytes : 0;
            return has_room;
        };
        if (!add()) {
            answer(exchange, busy(429, "this address has not read its earlier answers"));
            add();
        }
    }

    MHD_Result queue_response(MHD_Connection* connection, Exchange& exchange) {
        leave_lane(exchange);
        count_unread(exchange);
        auto& response = exchange.response;
        const auto bytes = content_bytes(exchange);
        deadlines.set(
            socket_of(connection),
            config.response_time +
                std::chrono::seconds{bytes / std::max<std::size_t>(config.slowest_bytes, 1)});
        if (handlers.record) {
            handlers.record({exchange.request.method,
                             exchange.route,
                             response.status,
                             bytes,
                             std::chrono::duration_cast<std::chrono::microseconds>(
                                 Clock::now() - exchange.begin)});
        }
        if (response.stream) {
            streams.add(response.stream);
        }
        const auto result = send_response(connection, response);
        response.file.reset(); // the connection has one of its own
        return result;
    }

    void completed(MHD_Connection* connection, void* request) override {
        deadlines.set(socket_of(connection), config.head_time); // of the next request
        const std::unique_ptr<Exchange> exchange{static_cast<Exchange*>(request)};
        if (!exchange) {
            return;
        }
        leave_lane(*exchange);
        loads.remove_unread(exchange->request.client, exchange->unread_bytes);
        if (exchange->is_counted) {
            loads.remove_request(exchange->request.client);
        }
        if (exchange->is_begun) {
            --at_work;
        }
        if (auto body = std::move(exchange->request.body)) { // cut; removing it takes a disk's time
            lanes[exchange->lane].add({[body](std::size_t) {}, [] {}});
        }
    }

    // ------------------------------------------------------------------------------- workers

    /// Hands the bytes that wait to the receiver of the body.
    void hand_on(Exchange& exchange) const {
        try {
            exchange.request.body->add(exchange.pending);
        } catch (const std::exception& error) { // a full disk
            exchange.refusal = busy(503, "the body cannot be stored now");
            exchange.request.body.reset(); // makes room at once
            if (handlers.failed) {
                handlers.failed(exchange.request.path, error.what());
            }
        }
        exchange.pending.clear();
    }

    /// Answers, and compresses the answer, which takes its time.
    void work_on(Exchange& exchange, std::size_t number) {
        std::string reason;
        if (!exchange.pending.empty()) {
            hand_on(exchange);
        }
        if (exchange.refusal) {
            answer(exchange, *std::move(exchange.refusal));
            return;
        }
        try {
            answer(exchange, handlers.answer(exchange.request, number));
            exchange.request.body.reset();
            return;
        } catch (const std::exception& error) {
            reason = error.what();
        } catch (...) {
            reason = "unknown exception";
        }
        if (handlers.failed) {
            handlers.failed(exchange.request.path, reason);
        }
        answer(exchange, http_problem(500, "the server's log says more"));
    }

    void drain(std::chrono::milliseconds at_most) {
        if (quiesced < 0) {
            quiesced = MHD_quiesce_daemon(daemon);
            if (!config.unix_socket.empty()) {
                unlink(config.unix_socket.c_str());
            }
        }
        streams.end_all();
        const auto end = Clock::now() + at_most;
        constexpr std::chrono::milliseconds pause{5};
        while (at_work > 0 && Clock::now() < end) {
            std::this_thread::sleep_for(pause);
        }
    }

    HttpServerConfig config;
    HttpHandlers handlers;
    int listening = -1;
    int quiesced = -1;
    std::uint16_t port = 0;
    MHD_Daemon* daemon = nullptr;
    mutable ConnectionDeadlines deadlines;
    std::atomic<std::size_t> connections = 0;
    std::atomic<std::size_t> at_work = 0;
    ClientLoads loads;
    std::vector<ClientLoads> lane_loads; ///< requests of each lane
    CompressedFiles compressed_files;
    OpenStreams streams;
    std::deque<WorkerLane> lanes;
};

HttpServer::HttpServer(HttpServerConfig config, HttpHandlers handlers)
    : impl_{std::make_unique<Impl>(std::move(config), std::move(handlers))} {}

HttpServer::~HttpServer() = default;

std::uint16_t HttpServer::port() const {
    return impl_->port;
}

std::size_t HttpServer::connections() const {
    return impl_->connections;
}

void HttpServer::drain(std::chrono::milliseconds at_most) {
    impl_->drain(at_most);
}

} // namespace macadam
