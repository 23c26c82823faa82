#pragma once

#include "storage/tables/text_lines.hpp"
#include "storage/trips/log/trip_row.hpp"
#include "storage/trips/mappings/column_mapping.hpp"

#include <optional>
#include <string>
#include <vector>

namespace macadam {

/// Reads the data rows of one table of a foreign log, in our units and axes.
class TableReader {
public:
    /// Reads up to the first data row.
    ///
    /// \throws InputError  if the header is missing, or lacks a column.
    TableReader(TextLines lines, const TableMapping& mapping, std::string name);

    /// Next row; `std::nullopt` at the end. Its time, at TripColumn::t_s, is relative to the origin
    /// of the table.
    ///
    /// A row is faulty as a whole if it has too many or too few cells, or text in place of a
    /// number.
    std::optional<TripRow> next();

    /// Tests whether the times of the rows read so far count from 1970.
    bool dated() const { return dated_; }

private:
    struct Source {
        std::size_t cell;
        ChannelMapping channel;
        std::optional<std::size_t> hemisphere; ///< its cell
    };

    std::optional<std::string_view> next_line();
    std::string header_line();
    void find_columns(const std::vector<std::string>& names);
    std::size_t index_of(const ColumnName& column, const std::vector<std::string>& names) const;
    TripRow row_of(std::vector<std::string> cells);
    std::optional<double> number_in(std::string cell) const;
    std::optional<double> value_in(const std::vector<std::string>& cells, const Source& from) const;
    double time_in(const std::vector<std::string>& cells);

    TextLines lines_;
    const TableMapping& mapping_;
    std::string name_;
    std::vector<std::size_t> time_cells_;
    std::vector<Source> sources_;
    std::size_t cell_count_ = 0; ///< 0: unknown, at least `min_cells_`
    std::size_t min_cells_ = 0;
    double midnights_s_ = 0;
    double last_clock_s_ = 0;
    bool dated_ = false;
};

} // namespace macadam
