#include "storage/tables/csv_table.hpp"

#include "estimator/common/error.hpp"
#include "estimator/common/exact_number.hpp"
#include "storage/files/byte_stream.hpp"
#include "storage/files/decompress.hpp"
#include "storage/files/hashed_bytes.hpp"
#include "storage/tables/csv_cells.hpp"
#include "storage/tables/text_lines.hpp"
#include "storage/text/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>

namespace macadam {
namespace {

std::optional<std::size_t> place_of(const std::vector<std::string>& header,
                                    std::string_view column) {
    const auto found = std::ranges::find(header, column);
    return found == header.end() ? std::nullopt
                                 : std::optional{static_cast<std::size_t>(found - header.begin())};
}

void expect_each_once(const std::vector<std::string>& header, const std::string& where) {
    std::set<std::string_view> seen;
    for (const auto& name : header) {
        if (!name.empty() && !seen.insert(name).second) {
            throw InputError{
                fmt::format("{}: column {} occurs twice, expected once", where, in_quotes(name))};
        }
    }
}

} // namespace

std::string CsvRow::text(std::string_view column) const {
    const auto place = place_of(*header_, column);
    return place ? cells_[*place] : "";
}

std::optional<double> CsvRow::number(std::string_view column,
                                     double least,
                                     double most,
                                     std::string_view expected) const {
    const auto cell = text(column);
    if (cell.empty()) {
        return std::nullopt;
    }
    const auto value = parse_number(cell);
    if (!value || !(*value >= least && *value <= most)) {
        throw InputError{
            fmt::format("{}: {} is {}, expected {}", where_, column, in_quotes(cell), expected)};
    }
    return value;
}

std::optional<std::int64_t> CsvRow::whole(std::string_view column) const {
    const auto cell = text(column);
    if (cell.empty()) {
        return std::nullopt;
    }
    const auto value = exact_number<std::int64_t>(cell);
    if (!value) {
        throw InputError{
            fmt::format("{}: {} is {}, expected a whole number", where_, column, in_quotes(cell))};
    }
    return value;
}

bool CsvTable::has(std::string_view column) const {
    return place_of(header, column).has_value();
}

CsvTable read_csv_table(const std::filesystem::path& file) {
    auto opened = std::make_unique<HashedBytes>(decompressed(file_bytes(file), file.string()));
    auto& bytes = *opened;
    TextLines lines{std::move(opened), file.string()};
    CsvTable table;
    table.header = cells_of_line(lines.next().value_or(""), ',');
    table.where = lines.where();
    expect_each_once(table.header, table.where);
    while (const auto line = lines.next()) {
        if (trimmed(*line).empty()) {
            continue;
        }
        auto cells = cells_of_line(*line, ',');
        if (cells.size() != table.header.size()) {
            throw InputError{fmt::format("{}: {} has {} cells, expected {}",
                                         lines.where(),
                                         in_quotes(*line),
                                         cells.size(),
                                         table.header.size())};
        }
        table.rows.push_back(std::move(cells));
        table.places.push_back(lines.where());
    }
    table.sha256 = bytes.sha256();
    return table;
}

} // namespace macadam
