#pragma once

#include "storage/postgres/server_connection.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace macadam {

/// Chunks of a database on a server that are marked to be fused, some at a time, in rounds over all
/// of them. Where few wait, the oldest come first; where more wait than are read at a time, each
/// has its turn in a round.
///
/// A chunk has a mark for each trip that came: the index leads from one chunk to the next, so that
/// the cost grows with the chunks that are read, not with all marks that wait.
class MarkedChunks {
public:
    static constexpr std::size_t usual_count = 50'000; ///< read in about a second

    /// \param at_a_time  how many next() returns at most
    explicit MarkedChunks(ServerConnection& server, std::size_t at_a_time = usual_count)
        : server_{&server}, at_a_time_{at_a_time} {}

    /// Begins a round where the last one was left.
    void begin_round();

    /// Chunks that are next in this round, oldest first: the same until advance() is called.
    /// \returns none at the end of the round.
    std::vector<std::int64_t> next();

    /// Goes on to those after the last that next() returned.
    void advance() { after_ = last_; }

private:
    std::vector<std::int64_t> read(std::int64_t to);

    ServerConnection* server_;
    std::size_t at_a_time_;
    std::int64_t begin_ = 0; ///< of the round: chunks after this one come first
    std::int64_t after_ = 0;
    std::int64_t last_ = 0;
    bool has_wrapped_ = false; ///< the round is among the chunks up to its begin
};

} // namespace macadam
