#include "app/trace/trace_live.hpp"

#include "app/pipeline/single_trip.hpp"
#include "app/pipeline/trip_preparation.hpp"
#include "app/pipeline/vehicle_lookup.hpp"
#include "app/trace/trace_rows.hpp"

#include "estimator/common/error.hpp"
#include "estimator/live/live_trace.hpp"
#include "storage/trips/trip_follower.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

namespace macadam {
namespace {

constexpr double judged_every_s = 60; // check of mounting, wheels and channels, given enough data

TraceRow row_of(const LiveRow& row) {
    return {.from_m = row.from_m,
            .to_m = row.to_m,
            .t_s = row.t_s,
            .at = row.at,
            .speed_mps = row.speed_mps,
            .mean = row.mean};
}

/// Prints the rows and returns their number.
std::size_t tell(const std::vector<LiveRow>& rows, bool json) {
    for (const auto& row : rows) {
        const auto& columns = trace_columns();
        print(json ? json_object(columns, row_of(row)).text() + "\n"
                   : csv_line(columns, row_of(row)));
    }
    if (!rows.empty()) {
        flush_results();
    }
    return rows.size();
}

/// Reports faulty rows: the first of each kind with its line, all of them at the end.
class DroppedSamples {
public:
    void look_at(const TripLog& row, const TripFollower& feed, const Console& console) {
        const auto reason = static_cast<RowReason>(row.rows.front());
        constexpr std::array faults{RowReason::wrong_cell_count,
                                    RowReason::bad_number,
                                    RowReason::out_of_range,
                                    RowReason::no_time};
        if (std::ranges::find(faults, reason) != faults.end() && ++counts_[name_of(reason)] == 1) {
            console.warn(fmt::format("{}: skipped: {}", feed.row_text(), name_of(reason)));
        }
    }

    void summarise(const TripFollower& feed, std::size_t out_of_order, const Console& console) {
        if (out_of_order > 0) {
            counts_[name_of(RowReason::time_not_increasing)] += out_of_order;
        }
        std::string reasons;
        for (const auto& [name, count] : counts_) {
            reasons += fmt::format("{}{} {}", reasons.empty() ? "" : ", ", name, count);
        }
        if (!reasons.empty()) {
            console.warn(fmt::format("skipped of {}: {}", counted(feed.count(), "row"), reasons));
        }
    }

private:
    std::map<std::string, std::size_t> counts_;
};

/// Reports each warning about the trip once.
class WarnOnce {
public:
    void look_at(const LiveTrace& live, Channels channels, const Console& console) {
        if (!live.ruler().odometer) {
            return;
        }
        if (!felt_) {
            expect_channels(live.recent(), live.mounting(), channels);
            felt_ = true; // a later gap in a channel does not count as its absence
        }
        for (const auto& warning :
             warnings_of(live.recent(), *live.ruler().odometer, live.mounting())) {
            if (said_.insert(warning.substr(0, warning.find_first_of("0123456789"))).second) {
                console.warn(warning);
            }
        }
        if (live.mount().hz > 0 && said_.insert("holder").second) {
            console.warn(holder_text(live.mount()));
        }
        if (const auto latency_s = live.found_latency_s(); latency_s && !latency_said_) {
            console.warn(fmt::format("GNSS delay estimated at {:.2f} s", *latency_s));
            latency_said_ = true;
        }
    }

    void look_at(const std::vector<LiveRow>& rows, Channels channels, const Console& console) {
        const bool lateral = std::ranges::any_of(rows, [](const LiveRow& row) {
            return (row.mean.validity & validity::indicative) != 0;
        });
        if (lateral && channels != Channels::lateral && said_.insert("lateral").second) {
            console.warn("no vertical acceleration: estimated from lateral acceleration only, "
                         "which is far less accurate");
        }
    }

private:
    std::set<std::string> said_; ///< messages up to the first number, which may vary
    bool latency_said_ = false;
    bool felt_ = false;
};

} // namespace

void trace_live(const std::filesystem::path& trip,
                const PipelineConfig& config,
                double length_m,
                bool json,
                const Arguments& arguments,
                const Console& console) {
    VehicleChoice vehicles{arguments};
    TripFollower feed{trip, needs_of_trace()};
    auto meta = feed.meta();
    with_trip_name(trip.string(), [&] { vehicles.name_car(meta); });
    const auto chosen = vehicles(trip, meta);
    if (!chosen.warning.empty()) {
        console.warn(chosen.warning);
    }
    for (const auto& column : feed.unknown_columns()) {
        console.warn(fmt::format("unknown column '{}' ignored", column));
    }
    LiveTrace live{meta,
                   chosen.vehicle,
                   {.odometer = config.odometer,
                    .stretch = config.stretch,
                    .estimator = config.estimator,
                    .window = {},
                    .length_m = length_m}};
    if (!json) {
        print(csv_header(trace_columns()));
        flush_results();
    }
    DroppedSamples left_out;
    WarnOnce said;
    std::size_t row_count = 0;
    const auto say = [&](const std::vector<LiveRow>& rows) {
        row_count += tell(rows, json);
        said.look_at(rows, config.estimator.channels, console);
    };
    std::optional<double> judge_s;
    while (const auto samples = feed.next()) {
        left_out.look_at(*samples, feed, console);
        with_trip_name(feed.name(), [&] {
            say(live.add(*samples));
            judge_s = judge_s || !live.ruler().odometer ? judge_s : live.now_s() + judged_every_s;
            if (judge_s && live.now_s() >= *judge_s) {
                said.look_at(live, config.estimator.channels, console);
                judge_s = live.now_s() + judged_every_s;
            }
        });
    }
    with_trip_name(feed.name(), [&] {
        said.look_at(live, config.estimator.channels, console);
        say(live.finish());
    });
    left_out.summarise(feed, live.dropped(), console);
    if (!feed.closed()) {
        console.warn(fmt::format("{}: the log ends here after {}, without '# end rows: N'",
                                 feed.where(),
                                 counted(feed.count(), "row")));
    }
    if (row_count == 0) {
        throw InputError{fmt::format("{}: is {:.1f} m long, expected at least --length {} m",
                                     feed.name(),
                                     live.travelled_m(),
                                     length_m)};
    }
}

} // namespace macadam
