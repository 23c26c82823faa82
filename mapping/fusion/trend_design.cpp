#include "mapping/fusion/trend_design.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace macadam {
namespace {

constexpr double ms_per_year = 365.25 * 86400e3;
constexpr double month_years = 1.0 / 12;
constexpr double max_walk_steps = 40;
constexpr double slope_from_years = month_years;
constexpr double season_from_years = 0.75; // a shorter span shows a trend, not a season

using Eigen::Index;
using Eigen::VectorXd;

/// Returns the start of each period between which the level may drift, youngest first; in steps.
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

/// Fills the entries of undated readings with the mean of the dated ones.
template <typename Column>
void fill_undated(Column& column, const Ages& ages) {
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

/// Fills the columns of a model one after the other.
class Columns {
public:
    Columns(MeanModel& model, const Ages& ages) : model_{&model}, ages_{&ages} {}

    /// Adds the level, which is in every reading.
    void add_level() {
        model_->columns.col(next_).setOnes();
        model_->precisions[next_++] = 0;
    }

    /// Adds a column.
    ///
    /// \param value  entry for a reading of the given age in years.
    template <typename Value>
    void add(double precision, const Value& value) {
        auto column = model_->columns.col(next_);
        for (Index i = 0; i < column.size(); ++i) {
            const double years = ages_->years[static_cast<std::size_t>(i)];
            column[i] = std::isnan(years) ? 0 : value(years);
        }
        fill_undated(column, *ages_);
        model_->precisions[next_++] = precision;
    }

private:
    MeanModel* model_;
    const Ages* ages_;
    Index next_ = 0;
};

double precision_of(double sd) {
    return 1 / (sd * sd);
}

double step_value(double years, double step_years) {
    return years > step_years ? -1.0 : 0.0;
}

void add_season(Columns& columns, const Ages& ages, double sd_um) {
    const double newest_years = static_cast<double>(ages.newest_ms) / ms_per_year;
    const auto turn = [&](double years) { return 2 * std::numbers::pi * (newest_years - years); };
    columns.add(precision_of(sd_um), [&](double years) { return std::cos(turn(years)); });
    columns.add(precision_of(sd_um), [&](double years) { return std::sin(turn(years)); });
}

double walk_step_years(const Ages& ages) {
    return std::max(month_years, ages.span_years / max_walk_steps);
}

void add_walk(Columns& columns,
              const Ages& ages,
              const std::vector<int>& bins,
              double sd_um_per_root_year) {
    const double step_years = walk_step_years(ages);
    for (std::size_t i = 1; i < bins.size(); ++i) {
        const double gap_years = step_years * (bins[i] - bins[i - 1]);
        const double from_years = step_years * bins[i];
        columns.add(precision_of(sd_um_per_root_year) / gap_years,
                    [&](double years) { return years >= from_years ? -1.0 : 0.0; });
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
    MeanModel model{MeanColumns(static_cast<Index>(ages.years.size()), 1), VectorXd(1)};
    Columns{model, ages}.add(0, [&](double years) { return step_value(years, step_years); });
    return model.columns.col(0);
}

MeanModel mean_model(const Ages& ages,
                     double level_um,
                     const ChangeModel& change,
                     std::span<const double> step_years) {
    const bool sloped = has_slope(ages);
    const bool seasoned = ages.span_years > season_from_years;
    const auto bins = sloped ? walk_of(ages, walk_step_years(ages)) : std::vector<int>{};
    const auto count = 1 + bins.size() + (seasoned ? 2U : 0U) + step_years.size();
    MeanModel model{MeanColumns(static_cast<Index>(ages.years.size()), static_cast<Index>(count)),
                    VectorXd(static_cast<Index>(count))};
    Columns columns{model, ages};
    columns.add_level();
    if (sloped) { // one column in addition to those between the bins
        columns.add(precision_of(std::hypot(change.slope_sd_per_year * level_um,
                                            change.slope_sd_um_per_year)),
                    [](double years) { return -years; });
        add_walk(columns, ages, bins, change.walk_sd_per_root_year * level_um);
    }
    if (seasoned) {
        add_season(columns, ages, change.season_sd * level_um);
    }
    for (const double step : step_years) {
        columns.add(0, [&](double years) { return step_value(years, step); });
    }
    return model;
}

} // namespace macadam
