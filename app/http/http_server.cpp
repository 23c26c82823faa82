#include "app/http/http_server.hpp"

#include "app/http/connection_deadlines.hpp"
#include "app/http/listening_socket.hpp"
#include "app/http/mhd_connection.hpp"
#include "app/http/request_check.hpp"
#include "app/http/response_finish.hpp"
#include "estimator/common/error.hpp"

#include <fmt/format.h>
#include <microhttpd.h>

#include <atomic>
#include <condition_variable>
#include <deque>
#include <exception>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include <unistd.h>

namespace macadam {
namespace {

using Clock = std::chrono::steady_clock;

/// Bytes of responses that clients have not yet read; more are refused, whoever reads slowly.
constexpr std::uint64_t max_unread_bytes = 256U << 20U;

/// Bytes that libmicrohttpd keeps for each connection: its head, and the head of the response.
constexpr std::size_t connection_bytes = std::size_t{40} * 1024;

/// Request with its response, from its first line until the response is sent.
struct Exchange {
    explicit Exchange(const char* uri) : target{take_target(uri)} {}

    std::string target;
    HttpRequest request{};
    FinishedResponse response{};
    std::string_view route{}; ///< of the response
    Clock::time_point begin = Clock::now();
    bool is_read = false; ///< whole
    std::optional<HttpResponse> refusal{};
    std::uint64_t body_bytes = 0; ///< that are to be read before an answer
    std::uint64_t received_bytes = 0;
    bool is_begun = false;
    bool is_counted = false;           ///< among the requests of its client
    std::atomic<bool> is_done = false; ///< by the worker
    std::uint64_t unread_bytes = 0;
};

/// Leaves targets encoded; they are decoded once (http_message.hpp).
std::size_t leave_encoded(void* /*server*/, MHD_Connection* /*connection*/, char* text) {
    return std::char_traits<char>::length(text);
}

} // namespace

struct HttpServer::Impl {
    Impl(HttpServerConfig its_config, HttpHandlers its_handlers)
        : config{std::move(its_config)}, handlers{std::move(its_handlers)} {
        listening = open_listening_socket(config.host, config.port);
        port = port_of(listening);
        for (std::size_t i = 0; i < config.workers; ++i) {
            workers.emplace_back([this, i](const std::stop_token& stop) { work(i, stop); });
        }
        start();
    }

    ~Impl() {
        drain(std::chrono::milliseconds{0});
        for (auto& worker : workers) {
            worker.request_stop();
        }
        arrived.notify_all();
        workers.clear();
        {
            const std::lock_guard lock{mutex};
            is_stopping = true;
            for (const auto& [connection, exchange] : queue) {
                answer(*exchange, http_problem(503, "the server stops"));
                exchange->is_done = true;
                MHD_resume_connection(connection);
            }
            queue.clear();
        }
        MHD_stop_daemon(daemon);
        if (quiesced >= 0) {
            close(quiesced);
        }
    }

    void start() {
        const auto per_address =
            config.behind_proxy ? 0U : static_cast<unsigned>(config.max_per_address);
        constexpr unsigned inactive_s = 120; // deadlines are shorter
        daemon = MHD_start_daemon(
            MHD_USE_EPOLL_INTERNAL_THREAD | MHD_ALLOW_SUSPEND_RESUME,
            0,
            nullptr,
            nullptr,
            [](void* server,
               MHD_Connection* connection,
               const char*,
               const char* method,
               const char*,
               const char* upload,
               std::size_t* upload_size,
               void** exchange) -> MHD_Result {
                try { // nothing may be thrown through the library, which is C
                    const std::string_view block{upload == nullptr ? "" : upload, *upload_size};
                    *upload_size = 0; // all of it is taken
                    return static_cast<Impl*>(server)->handle(
                        connection, method, block, *static_cast<Exchange*>(*exchange));
                } catch (const std::exception&) {
                    return MHD_NO; // ends the connection
                }
            },
            this,
            MHD_OPTION_LISTEN_SOCKET,
            listening,
            MHD_OPTION_CONNECTION_MEMORY_LIMIT,
            connection_bytes,
            MHD_OPTION_CONNECTION_LIMIT,
            static_cast<unsigned>(config.max_connections),
            MHD_OPTION_PER_IP_CONNECTION_LIMIT,
            per_address,
            MHD_OPTION_CONNECTION_TIMEOUT,
            inactive_s,
            MHD_OPTION_URI_LOG_CALLBACK,
            +[](void*, const char* uri, MHD_Connection*) -> void* { return new Exchange{uri}; },
            nullptr,
            MHD_OPTION_UNESCAPE_CALLBACK,
            &leave_encoded,
            nullptr,
            MHD_OPTION_NOTIFY_CONNECTION,
            +[](void* server,
                MHD_Connection* connection,
                void**,
                MHD_ConnectionNotificationCode code) {
                static_cast<Impl*>(server)->note_connection(connection, code);
            },
            this,
            MHD_OPTION_NOTIFY_COMPLETED,
            +[](void* server,
                MHD_Connection* connection,
                void** exchange,
                MHD_RequestTerminationCode) {
                static_cast<Impl*>(server)->complete(connection, static_cast<Exchange*>(*exchange));
                *exchange = nullptr;
            },
            this,
            MHD_OPTION_END);
        if (daemon == nullptr) {
            close(listening);
            throw InputError{fmt::format("cannot serve on {} port {}", config.host, port)};
        }
    }

    // ------------------------------------------------------------------- thread of the network

    void note_connection(MHD_Connection* connection, MHD_ConnectionNotificationCode code) {
        const int socket = socket_of(connection);
        if (code == MHD_CONNECTION_NOTIFY_STARTED) {
            ++connections;
            deadlines.set(socket, config.head_time);
        } else {
            --connections;
            deadlines.remove(socket);
        }
    }

    MHD_Result handle(MHD_Connection* connection,
                      const char* method,
                      std::string_view block,
                      Exchange& exchange) {
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
        return hand_to_worker(connection, exchange);
    }

    /// Takes a block of a body; that of a refused request is dropped, because a client that still
    /// sends would not see the answer.
    void receive(MHD_Connection* connection, Exchange& exchange, std::string_view block) const {
        exchange.received_bytes += block.size();
        if (!exchange.refusal && exchange.request.body) {
            try {
                exchange.request.body->add(block);
            } catch (const std::exception& error) { // a full disk
                exchange.refusal = busy(503, "the body cannot be stored now");
                exchange.request.body.reset(); // makes room at once
                if (handlers.failed) {
                    handlers.failed(exchange.request.path, error.what());
                }
            }
        }
        set_body_deadline(connection, exchange);
    }

    void set_body_deadline(MHD_Connection* connection, const Exchange& exchange) const {
        const auto end = exchange.begin + config.body_time +
                         std::chrono::seconds{exchange.received_bytes /
                                              std::max<std::size_t>(config.slowest_bytes, 1)};
        deadlines.set(socket_of(connection), end - Clock::now());
    }

    MHD_Result hand_to_worker(MHD_Connection* connection, Exchange& exchange) {
        deadlines.suspend(socket_of(connection));
        bool stops = false;
        {
            const std::lock_guard lock{mutex};
            stops = is_stopping;
            if (!stops) { // later, nobody would resume it
                MHD_suspend_connection(connection);
                queue.emplace_back(connection, &exchange);
            }
        }
        if (stops) {
            answer(exchange, busy(503, "the server stops"));
            return queue_response(connection, exchange);
        }
        arrived.notify_one();
        return MHD_YES;
    }

    /// Returns the response to a request that no worker needs to see.
    std::optional<HttpResponse>
    early_response(MHD_Connection* connection, const char* method, Exchange& exchange) {
        const auto head = head_of(connection, method, exchange.target);
        exchange.request.client = peer_of(socket_of(connection));
        if (auto refusal = decode_head(head, config, exchange.request)) {
            return refusal;
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
        const std::lock_guard lock{mutex};
        if (queue.size() >= config.max_waiting || unread_bytes > max_unread_bytes) {
            return busy(503, "more is asked than this server can answer now");
        }
        if (config.behind_proxy) {
            auto& count = requests_of[exchange.request.client];
            if (count >= config.max_per_address) {
                return busy(429, "too many requests of one address at once");
            }
            ++count;
            exchange.is_counted = true;
        }
        return std::nullopt;
    }

    static HttpResponse busy(int status, std::string_view words) {
        auto response = http_problem(status, words);
        response.headers.emplace_back("Retry-After", "1");
        return response;
    }

    /// Gives an exchange its response in the form in which it is sent.
    void answer(Exchange& exchange, HttpResponse response) const {
        exchange.route = response.route;
        exchange.response = finish(exchange.request, std::move(response), config.allowed_origin);
    }

    MHD_Result queue_response(MHD_Connection* connection, Exchange& exchange) {
        auto& response = exchange.response;
        const bool has_content = exchange.request.method != "HEAD" && response.status != 304;
        const auto bytes = has_content ? response.part.size : 0;
        exchange.unread_bytes = response.file ? 0 : bytes;
        unread_bytes += exchange.unread_bytes;
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
        const auto result = send_response(connection, response);
        response.file.reset(); // the connection has one of its own
        return result;
    }

    void complete(MHD_Connection* connection, Exchange* exchange) {
        deadlines.set(socket_of(connection), config.head_time); // of the next request
        if (exchange == nullptr) {
            return;
        }
        unread_bytes -= exchange->unread_bytes;
        if (exchange->is_counted) {
            const std::lock_guard lock{mutex};
            const auto count = requests_of.find(exchange->request.client);
            if (--count->second == 0) {
                requests_of.erase(count);
            }
        }
        if (exchange->is_begun) {
            --at_work;
        }
        delete exchange;
    }

    // ------------------------------------------------------------------------------- workers

    void work(std::size_t number, const std::stop_token& stop) {
        while (true) {
            std::unique_lock lock{mutex};
            if (!arrived.wait(lock, stop, [this] { return !queue.empty(); }) ||
                stop.stop_requested()) {
                return;
            }
            const auto [connection, exchange] = queue.front();
            queue.pop_front();
            lock.unlock();
            work_on(*exchange, number);
            exchange->is_done = true;
            MHD_resume_connection(connection);
        }
    }

    /// Answers, and compresses the answer, which takes its time.
    void work_on(Exchange& exchange, std::size_t number) const {
        std::string reason;
        try {
            answer(exchange, handlers.answer(exchange.request, number));
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
        }
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
    std::atomic<std::uint64_t> unread_bytes = 0;
    std::mutex mutex; ///< guards the three below
    bool is_stopping = false;
    std::deque<std::pair<MHD_Connection*, Exchange*>> queue;
    std::map<std::string, std::size_t> requests_of; ///< of clients, at work
    std::condition_variable_any arrived;
    std::vector<std::jthread> workers;
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
