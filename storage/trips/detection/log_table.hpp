#pragma once

#include "storage/trips/detection/column_names.hpp"
#include "storage/trips/detection/csv_dialect.hpp"
#include "storage/trips/detection/text_sample.hpp"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace macadam {

/// Column of a sample.
struct LogColumn {
    std::size_t number = 0; ///< from 1
    std::string name{};     ///< "" without one
    NamedColumn named{};
    std::vector<double> values{};     ///< a value for each row; NaN: none
    std::vector<std::string> texts{}; ///< cells of a column that is not numeric; otherwise empty
    std::size_t count = 0;            ///< of the values or texts that are not empty

    bool is_numeric() const { return texts.empty() && count > 0; }
};

/// First rows of a table of unknown make.
struct LogTable {
    CsvDialect dialect{};
    TextEncoding encoding = TextEncoding::utf8;
    std::vector<LogColumn> columns{};
    std::vector<std::string> empty{}; ///< words that stand for an empty cell, such as "-"
    std::size_t rows = 0;
};

/// Parses the rows of a sample: at most a million cells.
LogTable parse_log_table(const TextSample& sample, CsvDialect dialect);

/// Smallest and largest value other than 0, which stands for no position; infinities if there is
/// none.
std::pair<double, double> nonzero_range(const std::vector<double>& values);

/// Tests whether all values that are known are whole numbers.
bool are_whole(const std::vector<double>& values);

/// Median of the values that are numbers; NaN if there are none.
double known_median(std::vector<double> values);

} // namespace macadam
