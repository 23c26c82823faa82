#include "app/http/mhd_daemon.hpp"

#include <cstddef>
#include <exception>
#include <string>

namespace macadam {
namespace {

/// Bytes that libmicrohttpd keeps for each connection: its head, and the head of the response.
constexpr std::size_t connection_bytes = std::size_t{40} * 1024;

MhdEvents& events_of(void* events) {
    return *static_cast<MhdEvents*>(events);
}

MHD_Result handle(void* events,
                  MHD_Connection* connection,
                  const char* /*uri*/,
                  const char* method,
                  const char* /*version*/,
                  const char* upload,
                  std::size_t* upload_size,
                  void** request) {
    try { // nothing may be thrown through the library, which is C
        const std::string_view block{upload == nullptr ? "" : upload, *upload_size};
        *upload_size = 0; // all of it is taken
        return events_of(events).handle(connection, method, block, *request);
    } catch (const std::exception&) {
        return MHD_NO; // ends the connection
    }
}

void* begin(void* events, const char* uri, MHD_Connection* /*connection*/) {
    return events_of(events).begun(uri);
}

std::size_t leave_encoded(void* /*events*/, MHD_Connection* /*connection*/, char* text) {
    return std::char_traits<char>::length(text);
}

void note_connection(void* events,
                     MHD_Connection* connection,
                     void** /*own*/,
                     MHD_ConnectionNotificationCode code) {
    if (code == MHD_CONNECTION_NOTIFY_STARTED) {
        events_of(events).connected(connection);
    } else {
        events_of(events).disconnected(connection);
    }
}

void complete(void* events,
              MHD_Connection* connection,
              void** request,
              MHD_RequestTerminationCode /*code*/) {
    events_of(events).completed(connection, *request);
    *request = nullptr;
}

} // namespace

MHD_Daemon* start_daemon(MhdEvents& events, int listening_socket, const HttpServerConfig& config) {
    const auto per_address =
        config.behind_proxy ? 0U : static_cast<unsigned>(config.max_per_address);
    constexpr unsigned inactive_s = 120; // deadlines are shorter
    return MHD_start_daemon(MHD_USE_EPOLL_INTERNAL_THREAD | MHD_ALLOW_SUSPEND_RESUME,
                            0,
                            nullptr,
                            nullptr,
                            &handle,
                            &events,
                            MHD_OPTION_LISTEN_SOCKET,
                            listening_socket,
                            MHD_OPTION_CONNECTION_MEMORY_LIMIT,
                            connection_bytes,
                            MHD_OPTION_CONNECTION_LIMIT,
                            static_cast<unsigned>(config.max_connections),
                            MHD_OPTION_PER_IP_CONNECTION_LIMIT,
                            per_address,
                            MHD_OPTION_CONNECTION_TIMEOUT,
                            inactive_s,
                            MHD_OPTION_URI_LOG_CALLBACK,
                            &begin,
                            &events,
                            MHD_OPTION_UNESCAPE_CALLBACK,
                            &leave_encoded,
                            nullptr,
                            MHD_OPTION_NOTIFY_CONNECTION,
                            &note_connection,
                            &events,
                            MHD_OPTION_NOTIFY_COMPLETED,
                            &complete,
                            &events,
                            MHD_OPTION_END);
}

} // namespace macadam
