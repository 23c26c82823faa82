#include "storage/trips/positions/joined_trip.hpp"

#include "estimator/clocks/clock_offset.hpp"
#include "estimator/common/error.hpp"
#include "storage/text/utc.hpp"
#include "storage/trips/positions/gpx_reader.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>

namespace macadam {

namespace {

struct Span {
    double first_s = std::numeric_limits<double>::infinity();
    double last_s = -std::numeric_limits<double>::infinity();
};

Span span_of(const TripLog& trip) {
    Span span;
    const auto take = [&](double first_s, double last_s) {
        span = {std::min(span.first_s, first_s), std::max(span.last_s, last_s)};
    };
    for (const auto* const times : {&trip.acc.t_s, &trip.gyro.t_s, &trip.speed.t_s}) {
        if (!times->empty()) {
            take(times->front(), times->back());
        }
    }
    if (!trip.fixes.empty()) {
        take(trip.fixes.front().t_s, trip.fixes.back().t_s);
    }
    return span;
}

std::string utc_words(double t0_utc_s, const Span& span) {
    const auto utc = [&](double t_s) { return utc_text(std::llround((t0_utc_s + t_s) * 1000)); };
    return fmt::format("{} to {}", utc(span.first_s), utc(span.last_s));
}

void expect_overlap(const TripLog& log, const TripLog& positions, const std::string& file) {
    const auto of_log = span_of(log);
    const auto of_fixes = span_of(positions);
    const double offset_s = *positions.meta.t0_utc_s - *log.meta.t0_utc_s;
    if (of_log.first_s <= of_log.last_s && of_fixes.first_s <= of_fixes.last_s &&
        (of_fixes.first_s + offset_s > of_log.last_s ||
         of_fixes.last_s + offset_s < of_log.first_s)) {
        throw InputError{fmt::format(
            "{}: has positions from {}, expected some from {}, the times of the log; if a clock "
            "was in local time, state utc_offset_h or shift_s in a mapping, or leave t0_utc out",
            file,
            utc_words(*positions.meta.t0_utc_s, of_fixes),
            utc_words(*log.meta.t0_utc_s, of_log))};
    }
}

/// Drops the samples of a sensor that was read only for the clocks.
void drop(TriaxialSamples& samples, std::uint8_t flag, std::vector<std::uint8_t>& rows) {
    samples = {};
    for (auto& row : rows) {
        if (row < code(RowReason::wrong_cell_count) && (row & flag) != 0) {
            row = static_cast<std::uint8_t>(row & ~flag);
            row = row == 0 ? code(RowReason::unused_channel) : row;
        }
    }
}

ClockOffset found_offset(const TripLog& log,
                         const TripLog& positions,
                         const std::string& file,
                         const std::stop_token& stop) {
    const auto search = find_clock_offset(log, positions.fixes, stop);
    if (stop.stop_requested()) {
        throw InputError{file + ": reading was stopped"};
    }
    if (!search.found) {
        throw InputError{
            fmt::format("{}: the clocks of the log and of these positions cannot be joined: {}; "
                        "state the time of both in UTC (t0_utc, or [time] epoch or utc_offset_h "
                        "in a mapping)",
                        file,
                        search.words)};
    }
    return *search.found;
}

/// Compares stated times with the motion. \returns a doubt as the end of a sentence; "" if they
/// agree or the motion does not tell.
std::string doubt_about(double stated_s,
                        const TripLog& log,
                        const TripLog& positions,
                        const std::stop_token& stop) {
    constexpr double tolerated_s = 3; // delays of receivers and of logging
    const auto found = find_clock_offset(log, positions.fixes, stop).found;
    const double later_s = found ? found->offset_s - stated_s : 0;
    if (std::abs(later_s) <= tolerated_s) {
        return "";
    }
    return fmt::format(
        "; but speeds and turns fit best with the positions {:.1f} s {} (within {:.1f} "
        "s): one of the clocks is likely wrong; leave t0_utc out of the log to join "
        "them by speeds and turns",
        std::abs(later_s),
        later_s > 0 ? "later" : "earlier",
        2 * found->sd_s);
}

} // namespace

TripLog joined_trip(TripLog log,
                    TripLog positions,
                    const TripNeeds& needs,
                    const std::string& file,
                    const std::stop_token& stop) {
    const auto name = std::filesystem::path{file}.filename().string();
    if (positions.meta.other.contains(times_key)) {
        throw InputError{file + ": its points have no increasing times, expected times, to join "
                                "them to the log"};
    }
    ClockOffset offset{.offset_s = 0, .sd_s = 0};
    if (log.meta.t0_utc_s && positions.meta.t0_utc_s) {
        expect_overlap(log, positions, file);
        offset.offset_s = *positions.meta.t0_utc_s - *log.meta.t0_utc_s;
        log.meta.other[positions_key] =
            fmt::format("positions of {}, joined by the times that both state{}",
                        name,
                        doubt_about(offset.offset_s, log, positions, stop));
    } else {
        offset = found_offset(log, positions, file, stop);
        log.meta.other[positions_key] =
            fmt::format("positions of {}, {:.2f} s added to their times (found by speeds and "
                        "turns, within {:.2f} s)",
                        name,
                        offset.offset_s,
                        2 * offset.sd_s);
        if (positions.meta.t0_utc_s) {
            log.meta.t0_utc_s = *positions.meta.t0_utc_s - offset.offset_s;
        }
    }
    for (auto& fix : positions.fixes) {
        fix.t_s += offset.offset_s;
    }
    log.fixes = std::move(positions.fixes);
    if (!needs.acc) {
        drop(log.acc, row_content::acc, log.rows);
    }
    if (!needs.gyro) {
        drop(log.gyro, row_content::gyro, log.rows);
    }
    log.rows.insert(log.rows.end(), positions.rows.begin(), positions.rows.end());
    return log;
}

} // namespace macadam
