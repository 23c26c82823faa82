#include "storage/sqlite/sqlite.hpp"
#include "storage/store/connection/store_connection.hpp"
#include "storage/store/fusion/store_version.hpp"
#include "storage/store/reader/store_reader.hpp"
#include "storage/store/rows/old_changes.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <utility>

namespace macadam {
namespace {

std::vector<SegmentRange> ranges_of(Database& database,
                                    const std::vector<std::int64_t>& chunks,
                                    std::int64_t segments_per_chunk) {
    auto select = database.prepare("SELECT way_id, direction, seq FROM segment WHERE fid = ?");
    std::vector<SegmentRange> ranges;
    for (const auto chunk : chunks) {
        if (select.bind(chunk).step()) {
            const auto first = select.integer(2);
            const auto past = (first / segments_per_chunk + 1) * segments_per_chunk;
            ranges.push_back({select.integer(0),
                              select.text(1) == "forward",
                              static_cast<std::uint32_t>(first),
                              static_cast<std::uint32_t>(past)});
        }
    }
    return ranges;
}

/// Chunks in which trips have come or gone; `std::nullopt` after other maintenance.
std::optional<std::vector<std::int64_t>>
changed_chunks(Database& database, const StoreMoment& before, const StoreMoment& now) {
    const StoreVersion then{before.maintenance, before.last_trip};
    if (now.maintenance != before.maintenance) {
        return only_forgot(database, then, {now.maintenance, now.last_trip}) &&
                       std::max(before.last_audit, std::int64_t{1}) >= first_kept_audit(database)
                   ? std::optional{chunks_changed_from(database, before.last_audit)}
                   : std::nullopt;
    }
    return now.last_trip < before.last_trip ? std::nullopt
                                            : std::optional{chunks_driven_since(database, then)};
}

} // namespace

std::shared_ptr<const void> StoreReader::hold() const {
    struct Held {
        explicit Held(std::shared_ptr<StoreConnection> held)
            : store{std::move(held)}, one_moment{store->database, Transaction::Kind::read} {}
        std::shared_ptr<StoreConnection> store; // lives longer than its transaction
        Transaction one_moment;
    };
    return std::make_shared<const Held>(store_);
}

StoreMoment StoreReader::moment() const {
    auto& database = store_->database;
    const Transaction one_moment{database, Transaction::Kind::read};
    StoreMoment moment{.publication =
                           database.number("SELECT coalesce(max(number), 0) FROM publication"),
                       .published_alone = store_->published_alone};
    if (moment.published_alone) {
        moment.maintenance = count_of_maps(database); // no more of it shows
    } else {
        const auto [maintenance, last_trip] = moment_of(database);
        moment.maintenance = maintenance;
        moment.last_trip = last_trip;
        moment.last_audit = database.number("SELECT coalesce(max(id), 0) FROM main.audit");
        moment.waiting_chunks = dirty_chunks(database);
    }
    return moment;
}

std::optional<std::vector<SegmentRange>>
StoreReader::changed_since(const StoreMoment& before) const {
    auto& database = store_->database;
    const Transaction one_moment{database, Transaction::Kind::read};
    const auto now = moment();
    if (now.published_alone != before.published_alone) {
        return std::nullopt;
    }
    std::vector<std::int64_t> chunks;
    if (now.published_alone) {
        if (now.maintenance != before.maintenance || now.publication != before.publication) {
            return std::nullopt;
        }
    } else if (const auto changed = changed_chunks(database, before, now)) {
        std::ranges::set_union(*changed, before.waiting_chunks, std::back_inserter(chunks));
    } else {
        return std::nullopt;
    }
    return ranges_of(database, chunks, store_->segments_per_chunk());
}

} // namespace macadam
