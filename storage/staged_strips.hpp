#pragma once

#include "storage/sqlite.hpp"
#include "storage/strip_states.hpp"

#include <cstdint>
#include <optional>
#include <span>

namespace macadam {

/// Fused strips that are laid aside until they are put in place, in the temporary file of the
/// connection, which nobody else sees and which goes with it. One at a time for a connection, and
/// made outside of transactions.
class StagedStrips {
public:
    explicit StagedStrips(Database& database);
    StagedStrips(const StagedStrips&) = delete;
    StagedStrips& operator=(const StagedStrips&) = delete;
    ~StagedStrips();

    void put(std::int64_t strip, const FusedStrip& fused);

    /// Nothing if it is not there.
    std::optional<FusedStrip> find(std::int64_t strip);

    void remove(std::span<const std::int64_t> strips);
    void clear();

private:
    struct Table { ///< there before statements are made of it
        explicit Table(Database& database);
    };

    Database* database_;
    Table table_;
    Statement insert_;
    Statement select_;
    Statement remove_;
};

} // namespace macadam
