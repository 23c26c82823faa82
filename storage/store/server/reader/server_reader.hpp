#pragma once

#include "estimator/common/progress.hpp"
#include "storage/sqlite/lock_wait_policy.hpp"
#include "storage/store/connection/store_connection.hpp"
#include "storage/store/records/segment_filter.hpp"
#include "storage/store/server/copy/new_copy.hpp"

#include <memory>
#include <optional>
#include <string>

namespace macadam {

/// Part of a database on a server that a command reads.
struct ServerNeed {
    std::optional<SegmentFilter> segments{}; ///< only these; `std::nullopt`: anything
    PartContent content{.passes = true, .background = true};
};

/// Content of a database that may be read: all of a crowd only by its operator, who has the key and
/// a role that reads trips.
ServerContent content_for(ServerConnection& server, bool passes, Audience audience);

/// Opens what a command needs of a database on a server: a private copy of the chunks in question,
/// where they are few; else a copy of all that is kept for the next command (server_mirror.hpp),
/// without trips if no passes are needed. Of a crowd, publications alone unless content_for() says
/// more.
///
/// \throws InputError  if the server cannot be reached, or has no such database.
std::shared_ptr<StoreConnection> open_server_reader(const std::string& address,
                                                    const ServerNeed& need,
                                                    Audience audience,
                                                    const LockWaitPolicy& wait_policy,
                                                    const Progress& progress);

/// Opens a private copy of some chunks, with all else as if it were whole. The copy is removed with
/// the last user of the connection.
std::shared_ptr<StoreConnection> open_server_part(ServerConnection& server,
                                                  std::span<const ServerChunk> chunks,
                                                  const PartContent& content,
                                                  Audience audience,
                                                  const LockWaitPolicy& wait_policy,
                                                  const Progress& progress);

} // namespace macadam
