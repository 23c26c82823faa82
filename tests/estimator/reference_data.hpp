#pragma once

#include <string>
#include <vector>

namespace macadam::testing {

/// Rows of numbers of a table in tests/data, with blanks or commas between; an empty or wordy cell
/// is NaN, `skip` head lines are left out.
std::vector<std::vector<double>> read_table(const std::string& name, int skip);

/// One column of it.
std::vector<double> column(const std::vector<std::vector<double>>& table, std::size_t index);

/// The laser-measured road of tests/data/sorel.
struct Road {
    std::vector<double> station_m;
    std::vector<double> elevation_m;
};
Road sorel_even();
Road sorel_uneven();

/// The part of a road from `from_m` on.
Road starting_at(const Road& road, double from_m);

} // namespace macadam::testing
