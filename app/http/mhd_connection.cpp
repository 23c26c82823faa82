#include "app/http/mhd_connection.hpp"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include <fcntl.h>

namespace macadam {
namespace {

using Headers = std::vector<std::pair<std::string_view, std::string_view>>;

MHD_Result
collect_header(void* headers, MHD_ValueKind /*kind*/, const char* name, const char* value) {
    static_cast<Headers*>(headers)->emplace_back(name, value == nullptr ? "" : value);
    return MHD_YES;
}

void free_body(void* body) {
    delete static_cast<std::string*>(body);
}

MHD_Response* response_of(FinishedResponse& finished) {
    if (finished.file && finished.status != 304 && finished.status != 416) {
        const int file = fcntl(finished.file->open->number(), F_DUPFD_CLOEXEC, 0);
        return file < 0 ? nullptr
                        : MHD_create_response_from_fd_at_offset64(
                              finished.part.size, file, finished.part.first);
    }
    auto* const body = new std::string{std::move(finished.body)};
    return MHD_create_response_from_buffer_with_free_callback_cls(
        body->size(), body->data(), free_body, body);
}

} // namespace

std::string take_target(const char* uri) {
    std::string target{uri};
    auto* const text = const_cast<char*>(uri); // within the buffer of the connection
    if (const auto question = target.find('?'); question != std::string::npos) {
        std::replace(text + question, text + target.size(), '&', '_');
    }
    return target;
}

RequestHead head_of(MHD_Connection* connection, const char* method, const std::string& target) {
    RequestHead head{method, target, {}};
    MHD_get_connection_values(connection, MHD_HEADER_KIND, collect_header, &head.headers);
    return head;
}

bool has_body(MHD_Connection* connection) {
    return MHD_lookup_connection_value(connection, MHD_HEADER_KIND, "Content-Length") != nullptr ||
           MHD_lookup_connection_value(connection, MHD_HEADER_KIND, "Transfer-Encoding") != nullptr;
}

int socket_of(MHD_Connection* connection) {
    const auto* const info = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD);
    return info == nullptr ? -1 : info->connect_fd;
}

MHD_Result send_response(MHD_Connection* connection, FinishedResponse& finished) {
    auto* const response = response_of(finished);
    if (response == nullptr) { // no more files can be open
        return MHD_NO;
    }
    for (const auto& [name, value] : finished.headers) {
        MHD_add_response_header(response, name.c_str(), value.c_str());
    }
    const auto result =
        MHD_queue_response(connection, static_cast<unsigned>(finished.status), response);
    MHD_destroy_response(response);
    return result;
}

} // namespace macadam
