#pragma once

#include "app/http/request_check.hpp"
#include "app/http/response_finish.hpp"

#include <microhttpd.h>

#include <string>

namespace macadam {

// Connections of libmicrohttpd as the server uses them.

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

} // namespace macadam
