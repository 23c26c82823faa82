#include "app/http/mhd_connection.hpp"

#include "app/http/http_stream.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <unistd.h>

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

/// Stream with the connection that receives it.
struct ReceivedStream {
    std::shared_ptr<HttpStream> stream;
    MHD_Connection* connection;
};

ssize_t read_stream(void* received, std::uint64_t /*position*/, char* to, std::size_t max) {
    const auto& [stream, connection] = *static_cast<ReceivedStream*>(received);
    const auto count = stream->take(
        {to, max},
        [connection] { MHD_suspend_connection(connection); },
        [connection] { MHD_resume_connection(connection); });
    return !count        ? 0
           : *count == 0 ? MHD_CONTENT_READER_END_OF_STREAM
                         : static_cast<ssize_t>(*count);
}

void free_stream(void* received) {
    const std::unique_ptr<ReceivedStream> own{static_cast<ReceivedStream*>(received)};
    own->stream->close();
}

/// Part of a file that is being sent.
struct SentFile {
    std::shared_ptr<const HttpOpenFile> open;
    std::uint64_t first;
};

/// Reads on; a file that was written to meanwhile ends the connection before its end, since one
/// answer with parts of two versions would look whole.
ssize_t read_file(void* sent, std::uint64_t position, char* to, std::size_t max) {
    const auto& [open, first] = *static_cast<const SentFile*>(sent);
    const auto count = pread(open->number(), to, max, static_cast<off_t>(first + position));
    return count > 0 && open->is_unchanged() ? count : MHD_CONTENT_READER_END_WITH_ERROR;
}

void free_file(void* sent) {
    delete static_cast<SentFile*>(sent);
}

MHD_Response* response_of(MHD_Connection* connection, FinishedResponse& finished) {
    if (finished.stream) {
        constexpr std::size_t block = 4096;
        return MHD_create_response_from_callback(
            MHD_SIZE_UNKNOWN,
            block,
            read_stream,
            new ReceivedStream{std::move(finished.stream), connection},
            free_stream);
    }
    const bool has_file = finished.file && finished.status != 304 && finished.status != 416;
    if (has_file && finished.part.size > 0) {
        constexpr std::size_t block = std::size_t{32} * 1024;
        return MHD_create_response_from_callback(
            finished.part.size,
            block,
            read_file,
            new SentFile{finished.file->open, finished.part.first},
            free_file);
    }
    auto* const body = new std::string{std::move(finished.body)};
    return MHD_create_response_from_buffer_with_free_callback_cls(
        body->size(), body->data(), free_body, body);
}

// --------------------------------------------------------------------------- events of a daemon

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
    auto* const response = response_of(connection, finished);
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
