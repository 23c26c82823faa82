#include "storage/profiles/length_unit.hpp"
#include "storage/profiles/profile_rows.hpp"

#include "estimator/common/error.hpp"
#include "storage/files/byte_stream.hpp"
#include "storage/tables/text_lines.hpp"
#include "storage/text/text.hpp"

#include <fmt/core.h>

#include <array>
#include <cctype>
#include <cmath>
#include <utility>

namespace macadam {

namespace {

// Columns of a line: elevations, a comment, and, from profilers with a GNSS receiver, latitude,
// longitude, height, heading and speed.
constexpr std::size_t one_path = 2;
constexpr std::size_t one_path_with_fix = 7;
constexpr std::size_t two_paths = 3;
constexpr std::size_t two_paths_with_fix = 8;

std::vector<std::string_view> cells_of(std::string_view line) {
    std::vector<std::string_view> cells;
    for (;;) {
        const auto size = line.find(',');
        cells.push_back(trimmed(line.substr(0, size)));
        if (size == std::string_view::npos) {
            return cells;
        }
        line.remove_prefix(size + 1);
    }
}

/// Names a single path "left", "right" or "profile", as stated in the header.
std::string name_of_path(std::string_view path) {
    const auto letter = path.empty() ? '\0' : std::tolower(static_cast<unsigned char>(path[0]));
    return letter == 'l' ? "left" : letter == 'r' ? "right" : "profile";
}

class ProRows final : public ProfileRows {
public:
    ProRows(const std::filesystem::path& file, std::optional<double> step_m)
        : lines_{file_bytes(file), file.string()} {
        expect_record("HEAD3");
        expect_record("CMET3");
        read_units(step_m);
        lines_.next(); // initial position of the receiver
        lines_.next(); // a comment
        first_is_read_ = read_line();
        if (!first_is_read_) {
            throw InputError{
                fmt::format("{}: has no points after its five header lines", file.string())};
        }
        head_.tracks = tracks_ == 2 ? std::vector<std::string>{"left", "right"}
                                    : std::vector{name_of_path(path_)};
    }

    const ProfileHead& head() const override { return head_; }

    std::span<const double> next() override {
        if (!std::exchange(first_is_read_, false) && !read_line()) {
            return {};
        }
        row_.front() = static_cast<double>(count_++) * *head_.step_m;
        return row_;
    }

private:
    void expect_record(std::string_view word) {
        const auto line = lines_.next().value_or("");
        if (cells_of(line).front() != word) {
            throw InputError{fmt::format(
                "{}: {}, expected a record '{}'", lines_.where(), in_quotes(line), word)};
        }
    }

    /// Reads the manufacturer, unit of elevation, wheel path, point spacing and its unit.
    void read_units(std::optional<double> step_m) {
        constexpr std::size_t needed = 5;
        const auto line = lines_.next().value_or("");
        const auto cells = cells_of(line);
        const auto unit_m = cells.size() < needed ? std::nullopt : metres_in(cells[1]);
        const auto step = cells.size() < needed ? std::nullopt : parse_number(cells[3]);
        const auto step_unit_m = cells.size() < needed ? std::nullopt : metres_in(cells[4]);
        if (!unit_m || (!step_m && !(step && *step > 0 && step_unit_m))) {
            throw InputError{fmt::format("{}: {}, expected maker, unit of elevation, wheel path, "
                                         "distance between points and its unit ({})",
                                         lines_.where(),
                                         in_quotes(line, 80),
                                         length_units)};
        }
        unit_m_ = *unit_m;
        path_ = cells[2];
        head_.step_m = step_m ? step_m : *step * *step_unit_m;
    }

    /// Reads the elevations of the next line into row_, from index 1 on. Returns false at the end.
    bool read_line() {
        auto line = lines_.next();
        while (line && (trimmed(*line).empty() || *line == "\x1a")) { // the end of a DOS text
            line = lines_.next();
        }
        if (!line) {
            return false;
        }
        const auto cells = cells_of(*line);
        if (tracks_ == 0) {
            tracks_ = tracks_in(cells, *line);
            row_.resize(1 + tracks_);
        }
        for (std::size_t i = 0; i < tracks_; ++i) {
            const auto value = i < cells.size() ? parse_number(cells[i]) : std::nullopt;
            if (!value || !std::isfinite(*value)) {
                throw InputError{fmt::format("{}: {}, expected {} at its beginning",
                                             lines_.where(),
                                             in_quotes(*line),
                                             tracks_ == 2 ? "two elevations" : "an elevation")};
            }
            row_[1 + i] = unit_m_ * *value;
        }
        return true;
    }

    std::size_t tracks_in(const std::vector<std::string_view>& cells, std::string_view line) const {
        switch (cells.size()) {
        case one_path:
            // Without a comment: two elevations, unless the header states a single path.
            return name_of_path(path_) == "profile" && parse_number(cells[1]) ? 2 : 1;
        case one_path_with_fix:
            return 1;
        case two_paths:
        case two_paths_with_fix:
            return 2;
        default:
            throw InputError{fmt::format("{}: {} has {} cells, expected 2 or 3 (one or two "
                                         "elevations and a comment), or five more with a position",
                                         lines_.where(),
                                         in_quotes(line),
                                         cells.size())};
        }
    }

    TextLines lines_;
    ProfileHead head_;
    double unit_m_ = 0;
    std::string path_;
    std::size_t tracks_ = 0;
    std::vector<double> row_;
    std::size_t count_ = 0;
    bool first_is_read_ = false;
};

} // namespace

std::unique_ptr<ProfileRows> open_pro_profile(const std::filesystem::path& file,
                                              std::optional<double> step_m) {
    return std::make_unique<ProRows>(file, step_m);
}

} // namespace macadam
