#pragma once

#include "app/http/http_server.hpp"
#include "app/http/request_check.hpp"
#include "app/http/response_finish.hpp"

#include <microhttpd.h>

#include <string>
#include <string_view>

namespace macadam {

// libmicrohttpd as the server uses it.

/// Takes the target of a request as it came, for the server alone to decode. The library would keep
/// each parameter of the query, and closes the connection without an answer if its memory does not
/// suffice for them; in its copy there is one.
std::string take_target(const char* uri);

/// Head of a request whose target was taken; it refers to the connection.
RequestHead head_of(MHD_Connection* connection, const char* method, const std::string& target);

bool has_body(MHD_Connection* connection);

/// Number of the socket, -1 if there is none.
int socket_of(MHD_Connection* connection);

/// Hands a response to the connection, which takes its body and file.
MHD_Result send_response(MHD_Connection* connection, FinishedResponse& response);

/// Receiver of the events of a libmicrohttpd daemon, all from its thread.
class MhdEvents {
public:
    MhdEvents() = default;
    MhdEvents(const MhdEvents&) = delete;
    MhdEvents& operator=(const MhdEvents&) = delete;
    virtual ~MhdEvents() = default;

    virtual void connected(MHD_Connection* connection) = 0;
    virtual void disconnected(MHD_Connection* connection) = 0;

    /// Called with the first line of a request. \returns an object of its own for it.
    virtual void* begun(const char* uri) = 0;

    /// Called with the head, with each block of the body, at the end of it, and after each
    /// suspension. Exceptions end the connection.
    virtual MHD_Result handle(MHD_Connection* connection,
                              const char* method,
                              std::string_view block,
                              void* request) = 0;

    /// Called when the response is sent, or the client is gone.
    /// \param request  null: there was none
    virtual void completed(MHD_Connection* connection, void* request) = 0;
};

/// Starts a daemon: one thread (epoll) with the limits of a configuration; null if it cannot.
/// Targets are left encoded, as they are decoded once (http_message.hpp).
MHD_Daemon* start_daemon(MhdEvents& events, int listening_socket, const HttpServerConfig& config);

} // namespace macadam
