#include "estimator/common/error.hpp"
#include "storage/fold_case.hpp"
#include "storage/network_rows.hpp"
#include "storage/road_store_impl.hpp"
#include "storage/segment_row.hpp"
#include "storage/strip_states.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace macadam {
namespace {

/// Whether the straight line from `a` to `b` has a point in the box (Liang and Barsky's clipping).
bool meets(const GeoBox& box, const GeoPoint& a, const GeoPoint& b) {
    double enter = 0, leave = 1;
    const auto cut = [&](double from, double step, double low, double high) {
        if (step == 0) {
            return low <= from && from <= high;
        }
        const auto [near, far] = std::minmax({(low - from) / step, (high - from) / step});
        enter = std::max(enter, near);
        leave = std::min(leave, far);
        return enter <= leave;
    };
    return cut(a.lon_deg, b.lon_deg - a.lon_deg, box.west_deg, box.east_deg) &&
           cut(a.lat_deg, b.lat_deg - a.lat_deg, box.south_deg, box.north_deg);
}

bool meets(const GeoBox& box, const std::vector<GeoPoint>& line) {
    for (std::size_t i = 1; i < line.size(); ++i) {
        if (meets(box, line[i - 1], line[i])) {
            return true;
        }
    }
    return false;
}

// ------------------------------------------------------------------------------------ statements

/// What leads to the rows, each by an index of its own.
enum class Road { range, way, box, all };

Road road_to(const SegmentFilter& filter) {
    return filter.ranges || filter.key                                   ? Road::range
           : filter.way_id || (!filter.name_part.empty() && !filter.box) ? Road::way
           : filter.box                                                  ? Road::box
                                                                         : Road::all;
}

/// The joins stand in the order in which they are to be done. Only fixed words come together here,
/// never a value: those are bound by name.
std::string select_of(const SegmentFilter& filter, bool rows_in_order) {
    const auto road = road_to(filter);
    const auto* const state = filter.with_state_only
                                  ? " CROSS JOIN segment_state AS state ON state.fid = segment.fid"
                                  : " LEFT JOIN segment_state AS state ON state.fid = segment.fid";
    std::string sql = fmt::format("SELECT {} FROM ", record_columns);
    if (road == Road::all && filter.with_state_only) {
        sql += "segment_state AS state CROSS JOIN segment ON segment.fid = state.fid";
    } else {
        sql += "segment";
        sql += state;
    }
    sql += " WHERE 1";
    if (road == Road::box) {
        sql += " AND segment.fid >= :first AND segment.fid <= :last";
    }
    if (road == Road::way) {
        sql += " AND segment.way_id = :way";
    }
    if (road == Road::range) {
        sql += " AND segment.way_id = :way AND segment.direction = :direction"
               " AND segment.seq >= :first AND segment.seq < :past";
    }
    // The rows of one way always stand in the order of its keys.
    return sql + " ORDER BY " +
           (rows_in_order || road != Road::all ? "segment.fid" : order_of_keys);
}

/// Ways whose name holds the text in any case, in the order of their ids.
std::vector<std::int64_t> ways_named(Database& database, const std::string& part) {
    const auto folded_part = case_folded(part);
    auto select = database.prepare("SELECT name, way_id FROM way WHERE name IS NOT NULL");
    std::vector<std::int64_t> ways;
    std::string name;
    bool holds = false;
    while (select.step()) {
        if (auto other = select.text(0); other != name) { // neighbours in the index share names
            name = std::move(other);
            holds = case_folded(name).find(folded_part) != std::string::npos;
        }
        if (holds) {
            ways.push_back(select.integer(1));
        }
    }
    std::ranges::sort(ways);
    return ways;
}

/// Rows that stand one after the other.
struct RowRange {
    std::int64_t first;
    std::int64_t last;
};

/// Rows of segments that may meet the box, in the order of keys: SQLite would sort them with all
/// their columns. Each range is of one way where rows as such are in no order.
std::vector<RowRange> rows_near(Database& database, const GeoBox& box, bool rows_in_order) {
    auto select = database.prepare(
        fmt::format("SELECT id, {} FROM rtree_segment_geom AS place {} WHERE place.maxx >= ?"
                    " AND place.minx <= ? AND place.maxy >= ? AND place.miny <= ?",
                    rows_in_order ? "0" : "segment.way_id",
                    rows_in_order ? "" : "CROSS JOIN segment ON segment.fid = place.id"));
    std::vector<std::pair<std::int64_t, std::int64_t>> rows; // way, row
    for (select.bind(box.west_deg, box.east_deg, box.south_deg, box.north_deg); select.step();) {
        rows.emplace_back(select.integer(1), select.integer(0));
    }
    std::ranges::sort(rows);
    std::vector<RowRange> ranges;
    std::int64_t way = 0;
    for (const auto& [way_of_row, row] : rows) {
        if (ranges.empty() || way_of_row != way || row != ranges.back().last + 1) {
            ranges.push_back({row, row});
        }
        way = way_of_row;
        ranges.back().last = row;
    }
    return ranges;
}

std::vector<SegmentRange> ranges_of(const SegmentFilter& filter) {
    if (filter.ranges) {
        return *filter.ranges;
    }
    const auto& [way_id, forward, index] = *filter.key;
    return {{way_id, forward, index, index + 1}};
}

/// Runs the statement for each look-up in turn. \param row  is given the statement at each row.
template <typename Row>
void each_row(Database& database, const SegmentFilter& filter, const Row& row) {
    const bool rows_in_order = are_rows_in_order(database);
    auto select = database.prepare(select_of(filter, rows_in_order));
    const auto run = [&] {
        while (select.step()) {
            row(select);
        }
        select.reset();
    };
    switch (road_to(filter)) {
    case Road::range:
        for (const auto& range : ranges_of(filter)) {
            select.bind_named(":way", range.way_id);
            select.bind_named(":direction", range.forward ? "forward" : "backward");
            select.bind_named(":first", std::int64_t{range.first});
            select.bind_named(":past", std::int64_t{range.past});
            run();
        }
        return;
    case Road::way:
        for (const auto way :
             filter.way_id ? std::vector{*filter.way_id} : ways_named(database, filter.name_part)) {
            select.bind_named(":way", way);
            run();
        }
        return;
    case Road::box:
        for (const auto& [first, last] : rows_near(database, *filter.box, rows_in_order)) {
            select.bind_named(":first", first);
            select.bind_named(":last", last);
            run();
        }
        return;
    case Road::all:
        run();
    }
}

// -------------------------------------------------------------------------------------- records

/// What ways are called. Rows of a way come one after the other: joined, it would be looked up for
/// each of its segments.
class RoadNames {
public:
    explicit RoadNames(Database& database)
        : select_{database.prepare("SELECT name, highway FROM way WHERE way_id = ?")} {}

    /// \returns false for a way that the store does not have.
    bool find(std::int64_t way_id) {
        if (way_id != way_id_) {
            way_id_ = way_id;
            is_there_ = select_.bind(way_id).step();
            name_ = is_there_ ? select_.text(0) : "";
            highway_ = is_there_ ? select_.text(1) : "";
            select_.reset();
        }
        return is_there_;
    }

    /// Of the way that was found last.
    const std::string& name() const { return name_; }
    const std::string& highway() const { return highway_; }

private:
    Statement select_;
    std::optional<std::int64_t> way_id_;
    bool is_there_ = false;
    std::string name_;
    std::string highway_;
};

void expect_line(const SegmentRecord& record, const Database& database) {
    if (!is_line(record.segment.line)) {
        throw InputError{fmt::format("{}: segment '{}' has no line of places on the globe; the "
                                     "store was changed",
                                     database.file().string(),
                                     name_of(record.segment.key))};
    }
}

/// What some of the passes say of segments, strip by strip.
class ChosenStates {
public:
    ChosenStates(Database& database, double segment_length_m, const PassChoice& choice)
        : states_{database}, find_strip_{database.prepare(
                                 "SELECT strip FROM segment WHERE way_id = ?"
                                 " AND direction = ? AND seq = ?")},
          segment_length_m_{segment_length_m}, choice_{choice} {}

    std::optional<SegmentState> of(const SegmentKey& key) {
        if (const auto strip = strip_of(key, segment_length_m_); strip != strip_) {
            strip_ = strip;
            find_strip_.bind(
                key.way_id, key.forward ? "forward" : "backward", std::int64_t{key.index});
            fused_ = find_strip_.step() ? states_.of(find_strip_.integer(0),
                                                     segments_in_strip(segment_length_m_),
                                                     choice_)
                                        : std::vector<FusedSegment>{};
            find_strip_.reset();
        }
        const auto found = std::ranges::find(
            fused_, key, [](const FusedSegment& segment) { return segment.state.segment; });
        return found == fused_.end() ? std::nullopt : std::optional{found->state};
    }

private:
    StripStates states_;
    Statement find_strip_;
    double segment_length_m_;
    PassChoice choice_;
    std::optional<StripKey> strip_;
    std::vector<FusedSegment> fused_;
};

/// The conditions that no index serves.
class Conditions {
public:
    Conditions(const SegmentFilter& filter, const ClassTable& classes)
        : filter_{&filter}, classes_{&classes}, name_part_{case_folded(filter.name_part)} {}

    bool hold_for(const SegmentRecord& record) const {
        const auto& key = record.segment.key;
        return (!filter_->with_state_only || record.state) &&
               (!filter_->box || meets(*filter_->box, record.segment.line)) &&
               (!filter_->way_id || *filter_->way_id == key.way_id) &&
               (!filter_->key || *filter_->key == key) &&
               (name_part_.empty() ||
                case_folded(record.name).find(name_part_) != std::string::npos) &&
               passes_of(record) >= filter_->least_passes &&
               (filter_->class_name.empty() || filter_->class_name == class_of(record));
    }

private:
    static std::int32_t passes_of(const SegmentRecord& record) {
        return record.state ? record.state->passes : 0;
    }
    std::string_view class_of(const SegmentRecord& record) const {
        return record.state
                   ? classes_->classes[class_index(*classes_, mm_per_m(record.state->iri_um))].name
                   : std::string_view{};
    }

    const SegmentFilter* filter_;
    const ClassTable* classes_;
    std::string name_part_;
};

/// The n roughest of what is added, the roughest first; equal ones in the order of their keys.
class Roughest {
public:
    explicit Roughest(std::size_t n) : n_{n} {}

    void add(const SegmentRecord& record) {
        if (records_.size() == n_ && !rougher(record, records_.front())) {
            return;
        }
        records_.push_back(record);
        std::ranges::push_heap(records_, rougher);
        if (records_.size() > n_) {
            std::ranges::pop_heap(records_, rougher);
            records_.pop_back();
        }
    }

    std::vector<SegmentRecord> sorted() && {
        std::ranges::sort(records_, rougher);
        return std::move(records_);
    }

private:
    static bool rougher(const SegmentRecord& a, const SegmentRecord& b) {
        const auto order = [](const SegmentRecord& record) {
            return std::pair{record.state ? -record.state->iri_um : 1, record.segment.key};
        };
        return order(a) < order(b);
    }

    std::size_t n_;
    std::vector<SegmentRecord> records_; ///< a heap, the least rough at its front
};

} // namespace

void RoadStore::visit(const SegmentFilter& filter,
                      const std::function<void(const SegmentRecord&)>& visitor) const {
    auto& database = impl_->database;
    Transaction one_moment{database, Transaction::Kind::read};
    std::optional<ChosenStates> chosen;
    if (filter.period || filter.cars_alone) {
        chosen.emplace(database,
                       impl_->settings.segment_length_m,
                       PassChoice{filter.period, filter.cars_alone});
    }
    const Conditions conditions{filter, impl_->classes()};
    Roughest roughest{filter.worst};
    RoadNames names{database};
    SegmentRecord record; // of one row after the other, in the same memory
    each_row(database, filter, [&](const Statement& row) {
        if (!names.find(row.integer(0)) ||
            (!filter.highway.empty() && filter.highway != names.highway())) {
            return;
        }
        put_record_in(row, record);
        record.name = names.name();
        record.highway = names.highway();
        expect_line(record, database);
        if (chosen) {
            record.state = chosen->of(record.segment.key);
        }
        if (!conditions.hold_for(record)) {
            return;
        }
        if (filter.worst > 0) {
            roughest.add(record);
        } else {
            visitor(record);
        }
    });
    for (const auto& record : std::move(roughest).sorted()) {
        visitor(record);
    }
}

} // namespace macadam
