#include "app/http/http_server.hpp"

#include "app/http/connection_deadlines.hpp"
#include "app/http/listening_socket.hpp"
#include "app/http/request_check.hpp"
#include "app/http/response_finish.hpp"
#include "estimator/common/error.hpp"

#include <fmt/format.h>
#include <microhttpd.h>

#include <array>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <exception>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include <fcntl.h>
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
    explicit Exchange(std::string_view uri) : target{uri} {}

    std::string target;
    HttpRequest request{};
    HttpResponse response{};
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

MHD_Result
collect_header(void* headers, MHD_ValueKind /*kind*/, const char* name, const char* value) {
    static_cast<std::vector<std::pair<std::string_view, std::string_view>>*>(headers)->emplace_back(
        name, value == nullptr ? "" : value);
    return MHD_YES;
}

bool has_body(MHD_Connection* connection) {
    return MHD_lookup_connection_value(connection, MHD_HEADER_KIND, "Content-Length") != nullptr ||
           MHD_lookup_connection_value(connection, MHD_HEADER_KIND, "Transfer-Encoding") != nullptr;
}

int socket_of(MHD_Connection* connection) {
    const auto* const info = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD);
    return info == nullptr ? -1 : info->connect_fd;
}

/// Leaves targets encoded; they are decoded once (http_message.hpp).
std::size_t leave_encoded(void* /*server*/, MHD_Connection* /*connection*/, char* text) {
    return std::char_traits<char>::length(text);
}

void free_body(void* body) {
    delete static_cast<std::string*>(body);
}

MHD_Response* response_of(FinishedResponse& finished) {
    if (finished.file && finished.status != 304 && finished.status != 416) {
        const int file = open(finished.file->path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
        return file < 0 ? nullptr
                        : MHD_create_response_from_fd_at_offset64(
                              finished.part.size, file, finished.part.first);
    }
    auto* const body = new std::string{std::move(finished.body)};
    return MHD_create_response_from_buffer_with_free_callback_cls(
        body->size(), body->data(), free_body, body);
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
                exchange->response = http_problem(503, "the server stops");
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
            exchange.response = *std::move(exchange.refusal);
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
            exchange.response = busy(503, "the server stops");
            return queue_response(connection, exchange);
        }
        arrived.notify_one();
        return MHD_YES;
    }

    /// Returns the response to a request that no worker needs to see.
    std::optional<HttpResponse>
    early_response(MHD_Connection* connection, const char* method, Exchange& exchange) {
        RequestHead head{method, exchange.target, {}};
        MHD_get_connection_values(connection, MHD_HEADER_KIND, collect_header, &head.headers);
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

    MHD_Result queue_response(MHD_Connection* connection, Exchange& exchange) {
        const auto route = exchange.response.route;
        const bool is_head = exchange.request.method == "HEAD";
        auto finished =
            finish(exchange.request, std::move(exchange.response), config.allowed_origin);
        auto* response = response_of(finished);
        if (response == nullptr) { // the file has gone
            finished.status = 404;
            finished.part.size = 0;
            response = MHD_create_response_from_buffer(0, nullptr, MHD_RESPMEM_PERSISTENT);
        }
        for (const auto& [name, value] : finished.headers) {
            MHD_add_response_header(response, name.c_str(), value.c_str());
        }
        const auto bytes = is_head || finished.status == 304 ? 0 : finished.part.size;
        exchange.unread_bytes = finished.file ? 0 : bytes;
        unread_bytes += exchange.unread_bytes;
        deadlines.set(
            socket_of(connection),
            config.response_time +
                std::chrono::seconds{bytes / std::max<std::size_t>(config.slowest_bytes, 1)});
        if (handlers.record) {
            handlers.record({exchange.request.method,
                             route,
                             finished.status,
                             bytes,
                             std::chrono::duration_cast<std::chrono::microseconds>(
                                 Clock::now() - exchange.begin)});
        }
        const auto result =
            MHD_queue_response(connection, static_cast<unsigned>(finished.status), response);
        MHD_destroy_response(response);
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
            exchange->response = answered(exchange->request, number);
            exchange->is_done = true;
            MHD_resume_connection(connection);
        }
    }

    HttpResponse answered(const HttpRequest& request, std::size_t number) const {
        std::string reason;
        try {
            return handlers.answer(request, number);
        } catch (const std::exception& error) {
            reason = error.what();
        } catch (...) {
            reason = "unknown exception";
        }
        if (handlers.failed) {
            handlers.failed(request.path, reason);
        }
        return http_problem(500, "the server's log says more");
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
