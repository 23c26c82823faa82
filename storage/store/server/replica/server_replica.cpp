#include "storage/store/server/replica/server_replica.hpp"

#include "estimator/common/error.hpp"
#include "storage/store/rows/store_digest.hpp"
#include "storage/store/server/cells/cell_moves.hpp"
#include "storage/store/server/copy/store_copy.hpp"
#include "storage/store/server/reader/server_mirror.hpp"
#include "storage/store/server/replica/write_back.hpp"
#include "storage/store/server/server_digest.hpp"
#include "storage/store/server/server_locks.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <optional>
#include <utility>

namespace macadam {
namespace {

/// Replica with its server. Members end in reverse order: the connections before the folder.
class ServerReplica {
public:
    ServerReplica(const std::string& address,
                  const LockWaitPolicy& wait_policy,
                  const Progress& progress)
        : server_{address} {
        take_cell_places(server_);
        take_database(server_);
        copy_ = open_server_copy(server_, Database::Access::write, wait_policy, progress);
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
        const auto next = prepare_cells(server_);
        ServerTransaction all{server_};
        switch_cells(server_, next);
        write_back(server_, *copy_, changed);
        const auto digest = digest_of(database, {.report = {}, .stop = progress.stop});
        const auto written = digest_of_server(
            server_, static_cast<std::uint32_t>(copy_->segments_per_chunk()), progress);
        if (written != digest) {
            throw InputError{fmt::format("{}: would have the digest {}, expected {}: another "
                                         "program changed it in the meantime; nothing was written",
                                         server_.address(),
                                         written,
                                         digest)};
        }
        all.commit();
        remove_mirrors_of_fusion(server_); // even if a server of cells fails now
        drop_unused_cell_tables(server_);
        recorder_.emplace(database);
    }

    ServerConnection server_;
    std::shared_ptr<StoreConnection> copy_;
    std::optional<ChangeRecorder> recorder_;
};

} // namespace

std::shared_ptr<StoreConnection> open_server_replica(const std::string& address,
                                                     const LockWaitPolicy& wait_policy,
                                                     const Progress& progress) {
    auto replica = std::make_shared<ServerReplica>(address, wait_policy, progress);
    auto* const store = &replica->store();
    return {std::move(replica), store};
}

} // namespace macadam
