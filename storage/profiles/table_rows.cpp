#include "storage/profiles/profile_rows.hpp"

#include "estimator/common/error.hpp"
#include "storage/files/byte_stream.hpp"
#include "storage/tables/text_lines.hpp"
#include "storage/text/text.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace macadam {

namespace {

constexpr std::string_view station_column = "station_m";

/// First cell of a line, and the number of characters that it takes with its separator.
struct Cut {
    std::string_view cell;
    std::size_t taken;
};

Cut first_of_commas(std::string_view line) {
    const auto size = std::min(line.find(','), line.size());
    return {trimmed(line.substr(0, size)), size + 1};
}

/// First cell of a line separated by blanks. \param line  without blanks at its ends.
Cut first_of_blanks(std::string_view line) {
    const auto size = std::min(line.find_first_of(" \t"), line.size());
    const auto next = std::min(line.find_first_not_of(" \t", size), line.size());
    return {line.substr(0, size), std::max(next, size + 1)};
}

/// Calls `take` with each cell; a comma at the end of a line is followed by an empty cell.
template <typename First, typename Take>
void each_cell(std::string_view line, First first, Take take) {
    for (;;) {
        const auto [cell, taken] = first(line);
        take(cell);
        if (taken > line.size()) {
            return;
        }
        line.remove_prefix(taken);
    }
}

std::optional<std::string_view> next_not_blank(TextLines& lines) {
    auto line = lines.next();
    while (line && trimmed(*line).empty()) {
        line = lines.next();
    }
    return line;
}

std::vector<std::string> header_of(TextLines& lines) {
    std::vector<std::string> names;
    const auto line = next_not_blank(lines).value_or("");
    each_cell(line, first_of_commas, [&](std::string_view cell) {
        if (cell.empty() || parse_number(cell)) {
            throw InputError{fmt::format("{}: {}, expected a header with a name for each column",
                                         lines.where(),
                                         in_quotes(line))};
        }
        if (std::find(names.begin(), names.end(), cell) != names.end()) {
            throw InputError{fmt::format(
                "{}: column {} occurs twice, expected once", lines.where(), in_quotes(cell))};
        }
        names.emplace_back(cell);
    });
    return names;
}

/// Checks that the header begins with station_m, or lacks it if a step is given.
void expect_stations(const std::vector<std::string>& names,
                     const std::string& where,
                     bool has_stations) {
    const auto station = std::find(names.begin(), names.end(), station_column);
    if (has_stations && station != names.begin()) {
        throw InputError{fmt::format("{}: the first column is {}, expected '{}', or the option "
                                     "--step for elevations at even steps",
                                     where,
                                     in_quotes(names.front()),
                                     station_column)};
    }
    if (!has_stations && station != names.end()) {
        throw InputError{
            fmt::format("{}: the header has '{}', expected only elevations with the option "
                        "--step",
                        where,
                        station_column)};
    }
}

/// Names of unnamed tracks: "profile" for one, left and right for two.
std::vector<std::string> names_of(std::size_t tracks) {
    if (tracks == 1) {
        return {"profile"};
    }
    if (tracks == 2) {
        return {"left", "right"};
    }
    std::vector<std::string> names;
    for (std::size_t i = 1; i <= tracks; ++i) {
        names.push_back(fmt::format("track_{}", i));
    }
    return names;
}

/// Converts "left_m" to "left".
std::string track_name(std::string_view column) {
    if (column.ends_with("_m")) {
        column.remove_suffix(2);
    }
    return std::string{column};
}

class TableRows final : public ProfileRows {
public:
    TableRows(const std::filesystem::path& file, std::optional<double> step_m, bool commas)
        : lines_{file_bytes(file), file.string()}, commas_{commas} {
        head_.step_m = step_m;
        const std::size_t stations = step_m ? 0 : 1;
        if (commas) {
            const auto names = header_of(lines_);
            expect_stations(names, lines_.where(), !step_m);
            columns_ = names.size();
            for (std::size_t i = stations; i < names.size(); ++i) {
                head_.tracks.push_back(track_name(names[i]));
            }
        } else {
            first_is_read_ = read_line();
            columns_ = cells_.size();
            head_.tracks = names_of(columns_ - std::min(columns_, stations));
        }
        if (columns_ > 0 && head_.tracks.empty()) {
            throw InputError{
                fmt::format("{}: has only one column, expected stations and elevations, "
                            "or the option --step for elevations at even steps",
                            file.string())};
        }
    }

    const ProfileHead& head() const override { return head_; }

    std::span<const double> next() override {
        if (!std::exchange(first_is_read_, false) && !read_line()) {
            return {};
        }
        if (head_.step_m) {
            row_.assign(1, static_cast<double>(count_) * *head_.step_m);
            row_.insert(row_.end(), cells_.begin(), cells_.end());
        } else {
            expect_more(cells_.front());
            std::swap(row_, cells_);
        }
        ++count_;
        return row_;
    }

private:
    /// Reads the numbers of the next line into cells_. Returns false at the end.
    bool read_line() {
        const auto line = next_not_blank(lines_);
        if (!line) {
            return false;
        }
        cells_.clear();
        std::optional<std::string_view> bad;
        std::size_t bad_column = 0;
        const auto take = [&](std::string_view cell) {
            const auto value = parse_number(cell);
            if (!bad && (!value || !std::isfinite(*value))) {
                bad = cell;
                bad_column = cells_.size();
            }
            cells_.push_back(value.value_or(0));
        };
        if (commas_) {
            each_cell(*line, first_of_commas, take);
        } else {
            each_cell(trimmed(*line), first_of_blanks, take);
        }
        if (columns_ != 0 && cells_.size() != columns_) {
            throw InputError{fmt::format("{}: {} has {} cells, expected {}",
                                         lines_.where(),
                                         in_quotes(*line),
                                         cells_.size(),
                                         columns_)};
        }
        if (bad) {
            throw InputError{
                fmt::format("{}: {}, expected one {} in metres",
                            lines_.where(),
                            in_quotes(*bad),
                            bad_column == 0 && !head_.step_m ? "station" : "elevation")};
        }
        return true;
    }

    void expect_more(double station_m) const {
        if (count_ > 0 && station_m <= row_.front()) {
            throw InputError{fmt::format("{}: station '{}', expected more than the previous "
                                         "one, {}",
                                         lines_.where(),
                                         station_m,
                                         row_.front())};
        }
    }

    TextLines lines_;
    bool commas_;
    ProfileHead head_;
    std::size_t columns_ = 0; ///< of the file; 0 before the first line of a file without a header
    std::vector<double> cells_;
    std::vector<double> row_;
    std::size_t count_ = 0;
    bool first_is_read_ = false;
};

} // namespace

std::unique_ptr<ProfileRows> open_csv_profile(const std::filesystem::path& file,
                                              std::optional<double> step_m) {
    return std::make_unique<TableRows>(file, step_m, true);
}

std::unique_ptr<ProfileRows> open_txt_profile(const std::filesystem::path& file,
                                              std::optional<double> step_m) {
    return std::make_unique<TableRows>(file, step_m, false);
}

} // namespace macadam
