#include "estimator/common/error.hpp"
#include "mapping/fusion/utc_month.hpp"
#include "storage/store/connection/store_connection.hpp"
#include "storage/store/fusion/chunk_states.hpp"
#include "storage/store/reader/pass_choice.hpp"
#include "storage/store/reader/store_reader.hpp"
#include "storage/store/rows/segment_query.hpp"
#include "storage/store/rows/segment_row.hpp"
#include "storage/store/schema/network_rows.hpp"
#include "storage/text/case_folding.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace macadam {
namespace {

// -------------------------------------------------------------------------------------- records

/// Names and classes of ways. Rows of a way are consecutive, so each way is looked up once; a join
/// would look it up for each of its segments.
class RoadNames {
public:
    explicit RoadNames(StatementCache& statements)
        : select_{statements, "SELECT name, highway FROM way WHERE way_id = ?"} {}

    /// \returns false for a way that does not exist.
    bool find(std::int64_t way_id) {
        if (way_id != way_id_) {
            way_id_ = way_id;
            is_there_ = select_->bind(way_id).step();
            name_ = is_there_ ? select_->text(0) : "";
            highway_ = is_there_ ? select_->text(1) : "";
            select_->reset();
        }
        return is_there_;
    }

    /// Name of the way that was found last.
    const std::string& name() const { return name_; }
    const std::string& highway() const { return highway_; }

private:
    StatementCache::CachedStatement select_;
    std::optional<std::int64_t> way_id_;
    bool is_there_ = false;
    std::string name_;
    std::string highway_;
};

void expect_line(const SegmentRecord& record, const Database& database) {
    if (!is_line(record.segment.line)) {
        throw InputError{fmt::format("{}: segment '{}' has no valid line geometry; the "
                                     "database was modified by another program",
                                     database.file().string(),
                                     name_of(record.segment.key))};
    }
}

/// States of segments from a selection of passes, chunk by chunk.
class ChosenStates {
public:
    ChosenStates(Database& database, double segment_length_m, const PassChoice& choice)
        : states_{database}, find_chunk_{database.prepare(
                                 "SELECT strip FROM segment WHERE way_id = ?"
                                 " AND direction = ? AND seq = ?")},
          segment_length_m_{segment_length_m}, choice_{choice} {}

    std::optional<SegmentState> of(const SegmentKey& key) {
        if (const auto chunk = chunk_of(key, segment_length_m_); chunk != chunk_) {
            chunk_ = chunk;
            find_chunk_.bind(
                key.way_id, key.forward ? "forward" : "backward", std::int64_t{key.index});
            fused_ = find_chunk_.step() ? states_.of(find_chunk_.integer(0),
                                                     segments_per_chunk(segment_length_m_),
                                                     choice_)
                                        : std::vector<FusedSegment>{};
            find_chunk_.reset();
        }
        const auto found = std::ranges::find(
            fused_, key, [](const FusedSegment& segment) { return segment.state.segment; });
        return found == fused_.end() ? std::nullopt : std::optional{found->state};
    }

private:
    ChunkFusion states_;
    Statement find_chunk_;
    double segment_length_m_;
    PassChoice choice_;
    std::optional<ChunkKey> chunk_;
    std::vector<FusedSegment> fused_;
};

/// Published values of a period: the newest value within it.
class PublishedFigures {
public:
    PublishedFigures(Database& database, const Period& period)
        : select_{database.prepare(
              "SELECT figure.from_ms, figure.until_ms, iri_um, sd_um, low_um, high_um, left_um,"
              " right_um, centre_only, figure.flags, figure.passes, figure.vehicles"
              " FROM segment CROSS JOIN published_figure AS figure ON figure.segment = segment.fid"
              " WHERE way_id = ? AND direction = ? AND seq = ?"
              " AND figure.from_ms >= ? AND figure.until_ms <= ?"
              " ORDER BY figure.number DESC LIMIT 1")},
          period_{period} {
        expect_whole_months(database);
    }

    std::optional<SegmentState> of(const SegmentKey& key) {
        using Limits = std::numeric_limits<std::int64_t>;
        select_.bind(key.way_id,
                     key.forward ? "forward" : "backward",
                     std::int64_t{key.index},
                     period_.from_ms.value_or(Limits::min()),
                     period_.until_ms.value_or(Limits::max()));
        const auto state = select_.step() ? std::optional{state_in(key)} : std::nullopt;
        select_.reset();
        return state;
    }

private:
    void expect_whole_months(const Database& database) const {
        const auto is_whole = [](const std::optional<std::int64_t>& border_ms) {
            return !border_ms || month_begin_ms(*border_ms) == *border_ms;
        };
        if (!is_whole(period_.from_ms) || !is_whole(period_.until_ms)) {
            throw InputError{fmt::format("{}: values of a crowd database are given by whole "
                                         "months, expected times such as 2026-03",
                                         database.file().string())};
        }
    }

    SegmentState state_in(const SegmentKey& key) const {
        const auto um = [&](int column) { return static_cast<IriUm>(select_.integer(column)); };
        const auto known_um = [&](int column) {
            return select_.is_null(column) ? std::nullopt : std::optional{um(column)};
        };
        return {.segment = key,
                .iri_um = um(2),
                .sd_um = um(3),
                .low_um = um(4),
                .high_um = um(5),
                .left_um = known_um(6),
                .right_um = known_um(7),
                .centre_only = select_.integer(8) != 0,
                .validity = static_cast<std::uint8_t>(select_.integer(9)),
                .passes = static_cast<std::int32_t>(select_.integer(10)),
                .vehicles = static_cast<std::int32_t>(select_.integer(11)),
                .first_seen_ms = select_.integer(0),
                .last_seen_ms = month_begin_ms(select_.integer(1) - 1),
                .trend_um_per_year = std::nullopt,
                .trend_sd_um_per_year = std::nullopt,
                .change = std::nullopt};
    }

    Statement select_;
    Period period_;
};

/// Filter conditions without an index.
class Conditions {
public:
    Conditions(const SegmentFilter& filter, const ClassTable& classes)
        : filter_{&filter}, classes_{&classes}, place_{filter}, name_part_{case_folded(
                                                                    filter.name_part)} {}

    bool hold_for(const SegmentRecord& record) const {
        const auto& key = record.segment.key;
        return (!filter_->with_state_only || record.state) &&
               place_.holds_for(record.segment.line) &&
               (!filter_->way_id || *filter_->way_id == key.way_id) &&
               (!filter_->key || *filter_->key == key) &&
               (name_part_.empty() ||
                case_folded(record.name).find(name_part_) != std::string::npos) &&
               passes_of(record) >= filter_->min_passes &&
               (record.state ? record.state->vehicles : 0) >= filter_->min_vehicles &&
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
    PlaceCondition place_;
    std::string name_part_;
};

/// The n roughest of the added records, roughest first; ties in the order of their keys.
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
    std::vector<SegmentRecord> records_; ///< heap with the least rough in front
};

// -------------------------------------------------------------------------------------- reading

/// Columns to read from each row.
struct Detail {
    const char* columns;
    void (*put_in)(const VisitedRow& row, SegmentRecord& record);
};

void each_record(StoreConnection& store,
                 const Detail& detail,
                 const SegmentFilter& filter,
                 const std::function<void(const SegmentRecord&)>& visitor) {
    Transaction one_moment{store.database, Transaction::Kind::read};
    std::optional<ChosenStates> chosen;
    std::optional<PublishedFigures> figures;
    if (store.published_alone) { // published values are of cars only
        if (!filter.vehicle.empty()) {
            throw InputError{fmt::format("{}: is a crowd database, which tells no cars apart",
                                         store.database.file().string())};
        }
        if (filter.period) {
            figures.emplace(store.database, *filter.period);
        }
    } else if (selects_passes(filter)) {
        chosen.emplace(
            store.database, store.settings.segment_length_m, pass_choice(store.database, filter));
    }
    const Conditions conditions{filter, store.classes()};
    Roughest roughest{filter.worst};
    RoadNames names{store.statements};
    SegmentRecord record; // reused for all rows
    const auto take = [&](const VisitedRow& row) {
        if (!names.find(row.integer(0)) ||
            (!filter.highway.empty() && filter.highway != names.highway())) {
            return;
        }
        detail.put_in(row, record);
        record.name = names.name();
        record.highway = names.highway();
        expect_line(record, store.database);
        if (chosen) {
            record.state = chosen->of(record.segment.key);
        }
        if (figures) {
            record.state = figures->of(record.segment.key);
        }
        if (!conditions.hold_for(record)) {
            return;
        }
        if (filter.worst > 0) {
            roughest.add(record);
        } else {
            visitor(record);
        }
    };
    each_segment_row(store.statements, filter, detail.columns, take);
    for (const auto& each : std::move(roughest).sorted()) {
        visitor(each);
    }
}

SegmentSummary summary_of(const SegmentRecord& record) {
    SegmentSummary summary{
        record.segment.key, record.segment.line, record.name, record.highway, std::nullopt};
    if (const auto& state = record.state) {
        summary.roughness = {state->iri_um, state->sd_um, state->passes};
    }
    return summary;
}

} // namespace

void StoreReader::visit(const SegmentFilter& filter,
                        const std::function<void(const SegmentRecord&)>& visitor,
                        StateDetail detail) const {
    each_record(*store_,
                detail == StateDetail::tiles ? Detail{tile_columns, put_tile_record_in}
                                             : Detail{record_columns, put_record_in},
                filter,
                visitor);
}

void StoreReader::visit_summaries(const SegmentFilter& filter,
                                  const std::function<void(const SegmentSummary&)>& visitor) const {
    each_record(*store_,
                filter.min_vehicles > 0 ? Detail{tile_columns, put_tile_record_in}
                                        : Detail{summary_columns, put_summary_in},
                filter,
                [&](const SegmentRecord& record) { visitor(summary_of(record)); });
}

} // namespace macadam
