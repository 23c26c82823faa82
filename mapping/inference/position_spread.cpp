#include "mapping/inference/position_spread.hpp"

#include "estimator/common/statistics.hpp"
#include "mapping/inference/inferred_network.hpp"

#include <algorithm>
#include <numbers>

namespace macadam {
namespace {

constexpr double beside_m = 60;              // lines farther apart drove different roads
constexpr std::size_t max_samples = 5000;    // points compared with all others around them
constexpr double sd_per_median = 1 / 0.6745; // for absolute values of a normal distribution

} // namespace

std::vector<TraceLine> with_seen_sd(std::vector<TraceLine> lines, const TraceConfig& config) {
    TraceIndex index{config};
    std::size_t points = 0;
    for (std::size_t line = 0; line < lines.size(); ++line) {
        index.add(lines[line].points, line);
        points += lines[line].points.size();
    }
    const auto every = points / max_samples + 1;
    std::vector<double> apart;
    for (std::size_t line = 0; line < lines.size(); ++line) {
        const auto& own = lines[line].points;
        for (std::size_t i = every / 2; i < own.size(); i += every) {
            for (const auto& join : index.all_alike(own[i], course_rad(own, i), beside_m)) {
                if (join.at.way != line) {
                    apart.push_back(join.away_m);
                }
            }
        }
    }
    if (apart.empty()) {
        return lines;
    }
    const double sd_m = median(std::move(apart)) * sd_per_median / std::numbers::sqrt2;
    for (auto& line : lines) {
        line.sd_m = std::max(line.sd_m, sd_m);
    }
    return lines;
}

} // namespace macadam
