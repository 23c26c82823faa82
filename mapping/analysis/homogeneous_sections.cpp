#include "mapping/analysis/homogeneous_sections.hpp"

#include "estimator/common/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace macadam {
namespace {

constexpr double rounding = 1e-9; // of sums of squares: a boundary must gain more

/// Length-weighted sums over the first i intervals.
struct Sums {
    std::vector<double> length_m{0};
    std::vector<double> iri{0};
    std::vector<double> square{0};

    explicit Sums(std::span<const ProfilePiece> profile) {
        for (const auto& piece : profile) {
            const double piece_m = piece.to_m - piece.from_m;
            length_m.push_back(length_m.back() + piece_m);
            iri.push_back(iri.back() + piece_m * piece.iri);
            square.push_back(square.back() + piece_m * piece.iri * piece.iri);
        }
    }

    /// Returns the squared deviations of the intervals first <= i < last from their mean.
    double deviation(std::size_t first, std::size_t last) const {
        const double sum = iri[last] - iri[first];
        const double whole_m = length_m[last] - length_m[first];
        return std::max(0.0, square[last] - square[first] - sum * sum / whole_m);
    }
};

double scatter(std::span<const ProfilePiece> profile, double least) {
    std::vector<double> steps;
    for (std::size_t i = 1; i < profile.size(); ++i) {
        steps.push_back(std::abs(profile[i].iri - profile[i - 1].iri));
    }
    return std::max(least,
                    normal_sd_per_mad * median(std::move(steps)) /
                        std::sqrt(2.0)); // a difference has the scatter of two values
}

/// Returns the possible start of each section: at its interval, the first at 0.
std::vector<double> borders_of(double whole_m, std::span<const ProfilePiece> profile) {
    std::vector<double> borders{0};
    for (std::size_t i = 1; i < profile.size(); ++i) {
        borders.push_back(profile[i].from_m);
    }
    borders.push_back(whole_m);
    return borders;
}

/// Returns, for each number of intervals, the start of the last section in their optimal partition.
std::vector<std::size_t> best_beginnings(const Sums& sums,
                                         const std::vector<double>& borders,
                                         double price,
                                         double min_length_m) {
    constexpr double impossible = std::numeric_limits<double>::infinity();
    const auto n = borders.size() - 1;
    std::vector<double> cost(n + 1, impossible);
    std::vector<std::size_t> beginning(n + 1, 0);
    cost[0] = -price;
    for (std::size_t last = 1; last <= n; ++last) {
        for (std::size_t first = 0; first < last; ++first) {
            if (first > 0 && borders[last] - borders[first] < min_length_m) {
                break;
            }
            const double offer = cost[first] + sums.deviation(first, last) + price;
            if (offer < cost[last] - rounding) {
                cost[last] = offer;
                beginning[last] = first;
            }
        }
        // Too short for a section, unless it is the entire road.
        if (last < n && borders[last] < min_length_m) {
            cost[last] = impossible;
        }
    }
    return beginning;
}

} // namespace

std::vector<RouteMeasureRange> homogeneous_sections(double whole_m,
                                                    std::span<const ProfilePiece> profile,
                                                    const HomogeneousConfig& config) {
    if (profile.size() < 2) {
        return whole_m > 0 ? std::vector<RouteMeasureRange>{{0, whole_m}}
                           : std::vector<RouteMeasureRange>{};
    }
    const Sums sums{profile};
    const auto n = profile.size();
    const double sd = scatter(profile, config.min_scatter_mm_per_m);
    const double typical_m = sums.length_m.back() / static_cast<double>(n);
    const double price = config.penalty * sd * sd * typical_m * std::log(static_cast<double>(n));
    const auto borders = borders_of(whole_m, profile);
    const auto beginning = best_beginnings(sums, borders, price, config.min_length_m);

    std::vector<RouteMeasureRange> sections;
    for (auto last = n; last > 0; last = beginning[last]) {
        sections.push_back({borders[beginning[last]], borders[last]});
    }
    std::ranges::reverse(sections);
    return sections;
}

} // namespace macadam
