#include "render/roads/map_generalisation.hpp"

#include "mapping/tiles/run_joining.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace macadam {
namespace {

constexpr double everywhere = std::numeric_limits<double>::infinity();
constexpr std::array unmeasured_to{everywhere, everywhere, 1e6, 4e5, 1.5e5, 5e4}; // by rank
constexpr std::array named_to{3e5, 3e5, 1e5, 7.5e4, 5e4, 1.5e4};                  // by rank

double limit_of(const std::array<double, 6>& limits, int rank) {
    return limits[std::size_t(std::clamp(rank, 0, 5))];
}

/// Neighbouring lines of a road that look the same.
struct Run {
    double length; ///< m
    double sum;    ///< of IRI times length; NaN without IRI
    int iri_class;
    bool certain, few_passes;
    std::size_t first, past; ///< of the chain
};

Run run_of(const MapLine& line, std::size_t at) {
    double length_m = 0;
    for (std::size_t i = 0; i + 1 < line.line.size(); ++i) {
        length_m += distance_m(line.line[i], line.line[i + 1]);
    }
    return {length_m,
            line.iri_mm_per_m * length_m,
            line.iri_class,
            line.certain,
            line.few_passes,
            at,
            at + 1};
}

bool is_alike(const Run& a, const Run& b) {
    return a.iri_class == b.iri_class && a.certain == b.certain && a.few_passes == b.few_passes;
}

double apart(const Run& a, const Run& b) {
    const double iri = std::abs(a.sum / a.length - b.sum / b.length);
    return std::isfinite(iri) ? iri : std::abs(a.iri_class - b.iri_class);
}

} // namespace

bool is_shown(const MapLine& line, double scale_denominator) {
    return line.iri_class >= 0 || scale_denominator <= limit_of(unmeasured_to, line.rank);
}

bool is_named(int rank, double scale_denominator) {
    return scale_denominator <= limit_of(named_to, rank);
}

void join_short_classes(std::vector<MapLine>& lines,
                        const std::vector<LineUse>& uses,
                        const ClassTable& table,
                        double min_run_m) {
    const auto join = [&](Run& run, const Run& next) {
        if (next.length > run.length) {
            run.iri_class = next.iri_class;
            run.certain = next.certain;
            run.few_passes = next.few_passes;
        }
        run.length += next.length;
        run.sum += next.sum;
        run.past = next.past;
        if (const double mean = run.sum / run.length; std::isfinite(mean)) {
            run.iri_class = int(class_index(table, mean));
        }
    };
    for (const auto& chain : joined(lines, uses)) {
        if (lines[chain.front().line].iri_class < 0) {
            continue;
        }
        std::vector<Run> runs;
        for (std::size_t i = 0; i < chain.size(); ++i) {
            const auto run = run_of(lines[chain[i].line], i);
            if (!runs.empty() && is_alike(runs.back(), run)) {
                runs.back().length += run.length;
                runs.back().sum += run.sum;
                runs.back().past = run.past;
            } else {
                runs.push_back(run);
            }
        }
        join_short_runs(runs, min_run_m, is_alike, join, apart);
        for (const auto& run : runs) {
            for (const auto& use : std::span{chain}.subspan(run.first, run.past - run.first)) {
                auto& line = lines[use.line];
                line.iri_class = run.iri_class;
                line.certain = run.certain;
                line.few_passes = run.few_passes;
            }
        }
    }
}

} // namespace macadam
