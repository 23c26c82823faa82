#pragma once

#include "app/serve/ogc/items_query.hpp"
#include "mapping/network/segment.hpp"
#include "storage/store/reader/store_reader.hpp"
#include "storage/store/records/store_moment.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace macadam {

/// Selection takes longer than a request may.
struct SelectionTooLong {};

/// End of the time that a request may take to select features.
class TimeLimit {
public:
    explicit TimeLimit(std::chrono::milliseconds from_now = std::chrono::seconds{10})
        : end_{std::chrono::steady_clock::now() + from_now} {}

    /// Called for each feature.
    /// \throws SelectionTooLong  once the time is over
    void check();

private:
    std::size_t calls_ = 0;
    std::chrono::steady_clock::time_point end_;
};

/// Keys of the segments that a request selects, in order.
using SelectedKeys = std::shared_ptr<const std::vector<SegmentKey>>;

/// Keys of recent selections. A page is a range of them, so that counts are exact, `next` neither
/// repeats nor misses a segment, and a deep offset costs no more than the first. Those of a new
/// version are found among what has changed.
class SegmentSelections {
public:
    /// Returns the keys of a selection of one version of the database.
    /// \throws SelectionTooLong, InputError
    SelectedKeys
    keys(const StoreReader& store, const std::string& version, const ItemsQuery& query);

    /// Finds the keys of a new version, before anyone asks for it, for what was asked of the one
    /// before: a few selections that an update reaches.
    /// \throws InputError
    void prepare(const StoreReader& store, const std::string& version);

    static constexpr std::size_t max_keys = 4'000'000; ///< of all selections, 24 bytes each

private:
    struct Selection {
        ItemsQuery query;
        std::string version;
        StoreMoment moment{};
        std::uint64_t file = 0; ///< that the moment is of; 0 = it was replaced meanwhile
        SelectedKeys keys{};    ///< null: there is none so far
        bool is_asked = true;   ///< for this version
    };

    static std::optional<std::vector<SegmentRange>> changed_since(const StoreReader& store,
                                                                  const Selection& earlier);
    static Selection select(const StoreReader& store,
                            const std::string& version,
                            const ItemsQuery& query,
                            const Selection& earlier,
                            TimeLimit& limit);
    Selection latest(const std::string& text);
    std::vector<Selection> asked();
    void keep(Selection selection);

    std::mutex mutex_;
    std::list<Selection> recent_; ///< latest first, each text once
    std::size_t count_ = 0;       ///< of keys
};

/// Returns the filter of a request, as `query` and `export` build theirs.
SegmentFilter filter_of(const ItemsQuery& query);

/// Joins keys that follow one another to ranges.
std::vector<SegmentRange> ranges_of(std::span<const SegmentKey> keys);

} // namespace macadam
