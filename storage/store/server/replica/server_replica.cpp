#include "storage/store/server/replica/server_replica.hpp"

#include "estimator/common/error.hpp"
#include "storage/postgres/idle_limit.hpp"
#include "storage/store/rows/store_digest.hpp"
#include "storage/store/server/cells/cell_moves.hpp"
#include "storage/store/server/copy/new_copy.hpp"
#include "storage/store/server/copy/store_copy.hpp"
#include "storage/store/server/reader/server_mirror.hpp"
#include "storage/store/server/replica/database_part.hpp"
#include "storage/store/server/replica/part_to_forget.hpp"
#include "storage/store/server/replica/part_to_publish.hpp"
#include "storage/store/server/replica/write_back.hpp"
#include "storage/store/server/server_digest.hpp"
#include "storage/store/server/server_locks.hpp"
#include "storage/store/server/server_schema.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <utility>

namespace macadam {
namespace {

/// Replica with its server. Members end in reverse order: the connections before the folder.
class ServerReplica {
public:
    using FindPart = std::function<std::optional<DatabasePart>(ServerConnection&)>;

    /// \param find_part  part of the database that suffices, if any; null: all.
    ServerReplica(const std::string& address,
                  const FindPart& find_part,
                  const LockWaitPolicy& wait_policy,
                  const Progress& progress)
        : server_{address} {
        take_cell_places(server_);
        take_database(server_);
        if (find_part) {
            expect_server_schema(server_);
            part_ = find_part(server_);
        }
        copy_ = open_server_copy(server_,
                                 Database::Access::write,
                                 wait_policy,
                                 progress,
                                 [&](RowsFromServer& rows, Database& file) {
                                     if (part_) {
                                         fill_database_part(rows, file, *part_);
                                     } else {
                                         fill_copy(rows, file, ServerContent::all);
                                     }
                                 });
        if (part_) {
            copy_->part_to_publish = part_->to_publish;
        }
        recorder_.emplace(copy_->database);
        copy_->after_write = [this](const Progress& writing) { bring_back(writing); };
    }

    StoreConnection& store() { return *copy_; }

private:
    void bring_back(const Progress& progress) {
        const auto changed = changed_rows(*recorder_);
        if (changed.empty()) {
            return;
        }
        auto& database = copy_->database;
        const auto next = prepare_cells(server_, changing_cells());
        ServerTransaction all{server_};
        switch_cells(server_, next);
        set_idle_limit(server_, "0"); // the digest of all of a country takes long
        write_back(server_, *copy_, changed, part_ ? ReplicaExtent::part : ReplicaExtent::all);
        if (!part_) {
            expect_same_digest(progress);
        }
        all.commit();
        remove_mirrors_of_fusion(server_); // even if a server of cells fails now
        drop_unused_cell_tables(server_);
        recorder_.emplace(database);
    }

    /// Cells of which drives or fused values may change; `std::nullopt`: all.
    std::optional<std::set<std::int32_t>> changing_cells() const {
        if (!part_) {
            return std::nullopt;
        }
        std::set<std::int32_t> cells;
        for (const auto& chunk : part_->chunks) {
            cells.insert(chunk.cell);
        }
        return cells;
    }

    void expect_same_digest(const Progress& progress) {
        const auto digest = digest_of(copy_->database, {.report = {}, .stop = progress.stop});
        const auto written = digest_of_server(
            server_, static_cast<std::uint32_t>(copy_->segments_per_chunk()), progress);
        if (written != digest) {
            throw InputError{fmt::format("{}: would have the digest {}, expected {}: another "
                                         "program changed it in the meantime; nothing was written",
                                         server_.address(),
                                         written,
                                         digest)};
        }
    }

    ServerConnection server_;
    std::optional<DatabasePart> part_; ///< that the copy holds; else it holds all
    std::shared_ptr<StoreConnection> copy_;
    std::optional<ChangeRecorder> recorder_;
};

std::shared_ptr<StoreConnection> store_of(std::shared_ptr<ServerReplica> replica) {
    auto* const store = &replica->store();
    return {std::move(replica), store};
}

} // namespace

std::shared_ptr<StoreConnection> open_server_replica(const std::string& address,
                                                     const LockWaitPolicy& wait_policy,
                                                     const Progress& progress) {
    return store_of(std::make_shared<ServerReplica>(address, nullptr, wait_policy, progress));
}

std::shared_ptr<StoreConnection> open_replica_to_forget(const std::string& address,
                                                        const ForgetRequest& request,
                                                        const LockWaitPolicy& wait_policy,
                                                        const Progress& progress) {
    const auto find_part = [&](ServerConnection& server) {
        return part_to_forget(server, request);
    };
    return store_of(std::make_shared<ServerReplica>(address, find_part, wait_policy, progress));
}

std::shared_ptr<StoreConnection> open_replica_to_publish(const std::string& address,
                                                         const LockWaitPolicy& wait_policy,
                                                         const Progress& progress) {
    return store_of(
        std::make_shared<ServerReplica>(address, part_to_publish, wait_policy, progress));
}

} // namespace macadam
