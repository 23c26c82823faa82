#include "app/jobs/job_options.hpp"

#include "app/database/server_store.hpp"
#include "storage/jobs/worker_register.hpp"
#include "storage/objects/object_store.hpp"
#include "storage/postgres/server_address.hpp"
#include "storage/store/server/server_schema.hpp"

#include <fmt/format.h>

namespace macadam {

std::string server_of(const Arguments& arguments) {
    const auto store = file_or_server(arguments).string();
    if (!is_server_address(store)) {
        throw UsageError{fmt::format("STORE is the file {}, expected postgresql://USER@HOST/"
                                     "DATABASE: files have neither queue nor cells, and take "
                                     "trips by 'macadam import'",
                                     store)};
    }
    return store;
}

ServerConnection opened_server(const std::string& address) {
    ServerConnection server{address};
    expect_server_schema(server);
    return server;
}

std::string objects_of(const Arguments& arguments, ServerConnection& server) {
    if (const auto given = arguments.value("--objects")) {
        return absolute_location(*given);
    }
    if (auto last = objects_location(server)) {
        return *last;
    }
    throw UsageError{"--objects is missing, expected a folder or s3://BUCKET/PREFIX: nothing was "
                     "submitted to this database before"};
}

} // namespace macadam
