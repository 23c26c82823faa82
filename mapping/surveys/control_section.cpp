#include "mapping/surveys/control_section.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace macadam {
namespace {

constexpr double normal_975 = 1.959964; // of the normal distribution
constexpr double significant_sds = 2;

} // namespace

std::vector<SegmentRecord> cut_to(const ControlSection& section,
                                  std::vector<SegmentRecord> records) {
    std::erase_if(records, [&](SegmentRecord& record) {
        auto& [key, from_m, to_m, line] = record.segment;
        from_m = std::max(from_m, section.from_m);
        to_m = std::min(to_m, section.to_m);
        return key.way_id != section.way_id || key.forward != section.forward || from_m >= to_m;
    });
    return records;
}

double student_t_975(double degrees_of_freedom) {
    // The expansion about the normal quantile z (Abramowitz and Stegun, 26.7.5) has an error of 4 %
    // for 2 degrees of freedom, and below 0.1 % from 6 on; smaller degrees use tabulated values.
    constexpr std::array<double, 6> tabled{
        12.7062, 4.3027, 3.1824, 2.7764, 2.5706, 2.4469}; // 1 to 6
    const double n = std::max(1.0, degrees_of_freedom);
    if (n < 6) {
        const auto whole = static_cast<std::size_t>(n);
        const double part = n - static_cast<double>(whole);
        return tabled[whole - 1] + part * (tabled[whole] - tabled[whole - 1]);
    }
    const double z = normal_975;
    const double z2 = z * z;
    return z + z * (z2 + 1) / (4 * n) + z * (5 * z2 * z2 + 16 * z2 + 3) / (96 * n * n) +
           z * (3 * z2 * z2 * z2 + 19 * z2 * z2 + 17 * z2 - 15) / (384 * n * n * n);
}

std::optional<Drift> drift_of(std::span<const ControlReading> readings) {
    if (readings.size() < min_control_readings) {
        return std::nullopt;
    }
    double whole = 0, years = 0, off = 0;
    for (const auto& reading : readings) {
        const double weight = 1 / (reading.sd * reading.sd);
        whole += weight;
        years += weight * reading.years;
        off += weight * reading.off;
    }
    years /= whole;
    off /= whole;
    double spread = 0, both = 0;
    for (const auto& reading : readings) {
        const double weight = 1 / (reading.sd * reading.sd);
        spread += weight * (reading.years - years) * (reading.years - years);
        both += weight * (reading.years - years) * (reading.off - off);
    }
    if (!(spread > 0)) {
        return std::nullopt;
    }
    const double slope = both / spread;
    double scatter = 0;
    for (const auto& reading : readings) {
        const double left = reading.off - off - slope * (reading.years - years);
        scatter += left * left / (reading.sd * reading.sd);
    }
    const auto free = static_cast<double>(readings.size() - 2);
    const double widened = student_t_975(free) / normal_975;
    const double sd = widened * std::sqrt(scatter / free / spread);
    return Drift{slope, sd, std::abs(slope) > significant_sds * sd};
}

} // namespace macadam
