#include "storage/surveys/survey_reader.hpp"

#include "estimator/common/error.hpp"
#include "storage/files/byte_stream.hpp"
#include "storage/files/decompress.hpp"
#include "storage/tables/csv_cells.hpp"
#include "storage/tables/text_lines.hpp"
#include "storage/text/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

namespace macadam {
namespace {

constexpr double shortest_piece_m = 0.1; // of a row; surveys have 10 to 100 m
constexpr double longest_piece_m = 2000;
constexpr double max_mm_per_m = 1000; // rougher than any passable road

enum Column : std::uint8_t { lat, lon, from, to, iri, left, right, mri, hri, column_count };

constexpr std::array<std::string_view, column_count> names{
    "lat_deg", "lon_deg", "from_m", "to_m", "iri", "iri_left", "iri_right", "mri", "hri"};

/// Index of each column in a row.
using Columns = std::array<std::optional<std::size_t>, column_count>;

Columns columns_of(std::string_view header, const std::string& where) {
    const auto cells = cells_of_line(header, ',');
    Columns columns;
    for (std::size_t column = 0; column < column_count; ++column) {
        const auto found = std::ranges::find(cells, names[column]);
        if (found == cells.end()) {
            continue;
        }
        if (std::find(found + 1, cells.end(), names[column]) != cells.end()) {
            throw InputError{
                fmt::format("{}: column '{}' occurs twice, expected once", where, names[column])};
        }
        columns[column] = static_cast<std::size_t>(found - cells.begin());
    }
    const auto has_iri = [&] {
        return std::any_of(columns.begin() + iri, columns.end(), [](const auto& c) { return c; });
    };
    if (!columns[lat] || !columns[lon] || !has_iri()) {
        throw InputError{fmt::format("{}: {}, expected a header with lat_deg, lon_deg and one of "
                                     "iri, mri, hri, iri_left, iri_right",
                                     where,
                                     in_quotes(header, 80))};
    }
    if (columns[from].has_value() != columns[to].has_value()) {
        throw InputError{fmt::format("{}: the header has only '{}', expected both from_m and "
                                     "to_m",
                                     where,
                                     names[columns[from] ? from : to])};
    }
    return columns;
}

/// Cells of one row, by column.
class Cells {
public:
    Cells(std::string_view line, const Columns& columns, std::size_t count, std::string where)
        : cells_{cells_of_line(line, ',')}, columns_{columns}, where_{std::move(where)} {
        if (cells_.size() != count) {
            throw InputError{fmt::format(
                "{}: {} has {} cells, expected {}", where_, in_quotes(line), cells_.size(), count)};
        }
    }

    /// Number in a cell; `std::nullopt` for a missing column or an empty cell.
    std::optional<double>
    operator()(Column column, double least, double most, const char* expected) const {
        if (!columns_[column] || cells_[*columns_[column]].empty()) {
            return std::nullopt;
        }
        const auto& cell = cells_[*columns_[column]];
        const auto value = parse_number(cell);
        if (!value || !(*value >= least && *value <= most)) {
            throw refusal(column, expected);
        }
        return value;
    }

    InputError refusal(Column column, const char* expected) const {
        return InputError{fmt::format("{}: {} is {}, expected {}",
                                      where_,
                                      names[column],
                                      in_quotes(cells_[*columns_[column]]),
                                      expected)};
    }

private:
    std::vector<std::string> cells_;
    const Columns& columns_;
    std::string where_;
};

std::optional<double> length_of(const Cells& cells) {
    constexpr double far_m = 1e9;
    const auto from_m = cells(from, -far_m, far_m, "metres");
    const auto to_m = cells(to, -far_m, far_m, "metres");
    if (!from_m || !to_m) {
        return std::nullopt;
    }
    const double length_m = std::abs(*to_m - *from_m); // stations fall if driven in reverse
    if (!(length_m >= shortest_piece_m && length_m <= longest_piece_m)) {
        throw cells.refusal(to, "a station 0.1 to 2000 m from from_m");
    }
    return length_m;
}

/// Parses a row; `std::nullopt` if it has no position.
std::optional<SurveyRow> row_of(const Cells& cells, std::size_t line, double mm_per_m_of_one) {
    const auto lat_deg = cells(lat, -90, 90, "-90 to 90");
    const auto lon_deg = cells(lon, -180, 180, "-180 to 180");
    const auto roughness = [&](Column column) -> std::optional<double> {
        const auto value = cells(column, 0, max_mm_per_m / mm_per_m_of_one, "an IRI, or empty");
        return value ? std::optional{*value * mm_per_m_of_one} : std::nullopt;
    };
    const SurveyRow row{.line = line,
                        .at = {lat_deg.value_or(0), lon_deg.value_or(0)},
                        .length_m = length_of(cells),
                        .iri_mm_per_m = roughness(iri),
                        .left_mm_per_m = roughness(left),
                        .right_mm_per_m = roughness(right),
                        .mri_mm_per_m = roughness(mri),
                        .hri_mm_per_m = roughness(hri)};
    return lat_deg && lon_deg ? std::optional{row} : std::nullopt;
}

} // namespace

std::vector<SurveyRow> read_survey(const std::filesystem::path& file, double mm_per_m_of_one) {
    TextLines lines{decompressed(file_bytes(file), file.string()), file.string()};
    std::size_t number = 1;
    const auto header = lines.next();
    const auto columns = columns_of(header.value_or(""), lines.where());
    const auto count = cells_of_line(header.value_or(""), ',').size();
    std::vector<SurveyRow> survey;
    while (const auto line = lines.next()) {
        ++number;
        if (trimmed(*line).empty()) {
            continue;
        }
        const Cells cells{*line, columns, count, lines.where()};
        if (const auto row = row_of(cells, number, mm_per_m_of_one)) {
            survey.push_back(*row);
        }
    }
    if (survey.size() < 2) {
        throw InputError{fmt::format("{}: has {} with a position, expected at least two",
                                     file.string(),
                                     survey.size() == 1 ? "one row" : "no row")};
    }
    return survey;
}

} // namespace macadam
