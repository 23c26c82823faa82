#include "mapping/fusion/time_columns.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace macadam {
namespace {

constexpr double ms_per_year = 365.25 * 86400e3;
constexpr double month_years = 1.0 / 12;
constexpr double most_walk_steps = 40;
constexpr double slope_from_years = month_years;
constexpr double season_from_years = 0.75; // less of a year is no season but a trend

using Eigen::Index;
using Eigen::VectorXd;

/// Beginnings of the times between which the level may wander, youngest first; in steps.
std::vector<int> walk_of(const Ages& ages, double step_years) {
    std::vector<int> bins;
    for (const double years : ages.years) {
        if (!std::isnan(years)) {
            bins.push_back(static_cast<int>(years / step_years));
        }
    }
    std::ranges::sort(bins);
    const auto rest = std::ranges::unique(bins);
    bins.erase(rest.begin(), rest.end());
    return bins;
}

/// What a column has for undated readings: the mean of those with a date.
void fill_undated(Eigen::Ref<VectorXd> column, const Ages& ages) {
    double sum = 0;
    int dated = 0;
    for (Index i = 0; i < column.size(); ++i) {
        if (!std::isnan(ages.years[static_cast<std::size_t>(i)])) {
            sum += column[i];
            ++dated;
        }
    }
    for (Index i = 0; i < column.size(); ++i) {
        if (std::isnan(ages.years[static_cast<std::size_t>(i)])) {
            column[i] = dated > 0 ? sum / dated : 0;
        }
    }
}

template <typename Value>
VectorXd column_of(const Ages& ages, const Value& value) {
    VectorXd column(static_cast<Index>(ages.years.size()));
    for (Index i = 0; i < column.size(); ++i) {
        const double years = ages.years[static_cast<std::size_t>(i)];
        column[i] = std::isnan(years) ? 0 : value(years);
    }
    fill_undated(column, ages);
    return column;
}

struct Term {
    VectorXd column;
    double precision;
};

double precision_of(double sd) {
    return 1 / (sd * sd);
}

void add_season(std::vector<Term>& terms, const Ages& ages, double sd_um) {
    const double newest_years = static_cast<double>(ages.newest_ms) / ms_per_year;
    const auto turn = [&](double years) { return 2 * std::numbers::pi * (newest_years - years); };
    terms.push_back({column_of(ages, [&](double years) { return std::cos(turn(years)); }),
                     precision_of(sd_um)});
    terms.push_back({column_of(ages, [&](double years) { return std::sin(turn(years)); }),
                     precision_of(sd_um)});
}

void add_walk(std::vector<Term>& terms, const Ages& ages, double sd_um_per_root_year) {
    const double step_years = std::max(month_years, ages.span_years / most_walk_steps);
    const auto bins = walk_of(ages, step_years);
    for (std::size_t i = 1; i < bins.size(); ++i) {
        const double gap_years = step_years * (bins[i] - bins[i - 1]);
        const double from_years = step_years * bins[i];
        terms.push_back(
            {column_of(ages, [&](double years) { return years >= from_years ? -1.0 : 0.0; }),
             precision_of(sd_um_per_root_year) / gap_years});
    }
}

} // namespace

Ages ages_of(const std::vector<std::optional<std::int64_t>>& utc_ms) {
    Ages ages{{}, 0, 0};
    bool dated = false;
    for (const auto& time : utc_ms) {
        if (time) {
            ages.newest_ms = dated ? std::max(ages.newest_ms, *time) : *time;
            dated = true;
        }
    }
    for (const auto& time : utc_ms) {
        const double years = time ? static_cast<double>(ages.newest_ms - *time) / ms_per_year
                                  : std::numeric_limits<double>::quiet_NaN();
        ages.years.push_back(years);
        ages.span_years = time ? std::max(ages.span_years, years) : ages.span_years;
    }
    return ages;
}

bool has_slope(const Ages& ages) {
    return ages.span_years > slope_from_years;
}

VectorXd step_column(const Ages& ages, double step_years) {
    return column_of(ages, [&](double years) { return years > step_years ? -1.0 : 0.0; });
}

MeanModel mean_model(const Ages& ages,
                     double level_um,
                     const ChangeModel& change,
                     std::span<const double> step_years) {
    const auto count = static_cast<Index>(ages.years.size());
    std::vector<Term> terms{{VectorXd::Ones(count), 0}};
    if (has_slope(ages)) {
        terms.push_back({column_of(ages, [](double years) { return -years; }),
                         precision_of(std::hypot(change.slope_sd_per_year * level_um,
                                                 change.slope_sd_um_per_year))});
        add_walk(terms, ages, change.walk_sd_per_root_year * level_um);
    }
    if (ages.span_years > season_from_years) {
        add_season(terms, ages, change.season_sd * level_um);
    }
    for (const double years : step_years) {
        terms.push_back({step_column(ages, years), 0});
    }
    MeanModel model{{count, static_cast<Index>(terms.size())},
                    VectorXd(static_cast<Index>(terms.size()))};
    for (Index i = 0; const auto& term : terms) {
        model.columns.col(i) = term.column;
        model.precisions[i++] = term.precision;
    }
    return model;
}

} // namespace macadam
