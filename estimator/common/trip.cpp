#include "estimator/common/trip.hpp"

#include <algorithm>
#include <cassert>

namespace macadam {
namespace {

constexpr std::uint8_t first_reason = 16; // smaller values are sums of row_content flags

/// Reads the use of one stream's samples in row order.
struct Reader {
    const std::vector<std::uint8_t>& use;
    std::size_t next = 0;

    std::uint8_t operator()() {
        assert(next < use.size());
        return use[next++];
    }
};

} // namespace

const char* name_of(RowReason reason) {
    switch (reason) {
    case RowReason::wrong_cell_count:
        return "wrong_cell_count";
    case RowReason::bad_number:
        return "bad_number";
    case RowReason::out_of_range:
        return "out_of_range";
    case RowReason::no_time:
        return "no_time";
    case RowReason::no_sample:
        return "no_sample";
    case RowReason::time_not_increasing:
        return "time_not_increasing";
    case RowReason::unused_channel:
        return "unused_channel";
    case RowReason::too_slow:
        return "too_slow";
    case RowReason::short_stretch:
        return "short_stretch";
    case RowReason::no_speed:
        return "no_speed";
    case RowReason::implausible:
        return "implausible";
    case RowReason::inaccurate:
        return "inaccurate";
    case RowReason::repeated_fix:
        return "repeated_fix";
    case RowReason::merged:
        return "merged";
    case RowReason::trimmed:
        return "trimmed";
    case RowReason::sensor_moved:
        return "sensor_moved";
    }
    assert(false);
    return "";
}

std::vector<double> times_of(const std::vector<GnssFix>& fixes) {
    std::vector<double> t_s(fixes.size());
    std::ranges::transform(fixes, t_s.begin(), &GnssFix::t_s);
    return t_s;
}

RowCount account(const TripLog& trip, const RowAudit& use) {
    // Order of precedence of the reasons of a rejected row.
    struct Stream {
        std::uint8_t flag;
        Reader read;
    };
    Stream streams[] = {{row_content::acc, {use.acc}},
                        {row_content::gyro, {use.gyro}},
                        {row_content::speed, {use.speed}},
                        {row_content::fix, {use.fixes}}};

    std::array<std::size_t, 256> rejected{};
    RowCount count;
    for (const std::uint8_t row : trip.rows) {
        ++count.read;
        std::uint8_t reason = row >= first_reason ? row : 0;
        bool used = false;
        for (auto& [flag, read] : streams) {
            if (row < first_reason && (row & flag) != 0) {
                const std::uint8_t why = read();
                used = used || why == 0;
                reason = reason == 0 ? why : reason;
            }
        }
        if (used) {
            ++count.used;
        } else {
            ++count.rejected;
            ++rejected[reason];
        }
    }
    for (std::size_t reason = first_reason; reason < rejected.size(); ++reason) {
        if (rejected[reason] > 0) {
            count.reasons[name_of(static_cast<RowReason>(reason))] = rejected[reason];
        }
    }
    return count;
}

} // namespace macadam
