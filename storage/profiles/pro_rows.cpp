#include "storage/profiles/length_unit.hpp"
#include "storage/profiles/profile_rows.hpp"

#include "estimator/common/error.hpp"
#include "storage/files/byte_stream.hpp"
#include "storage/tables/text_lines.hpp"
#include "storage/text/text.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <utility>

namespace macadam {

namespace {

// Columns of a line where the header does not state the wheel path: elevations, a comment, and,
// from profilers with a GNSS receiver, latitude, longitude, height, heading and speed.
constexpr std::size_t one_path = 2;
constexpr std::size_t one_path_with_fix = 7;
constexpr std::size_t two_paths = 3;
constexpr std::size_t two_paths_with_fix = 8;

/// Marks that begin a line of comment between points.
constexpr std::string_view comment_marks = "#;*!/";

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

bool has_letters(std::string_view text) {
    return std::ranges::any_of(text, [](unsigned char c) { return std::isalpha(c) != 0; });
}

/// Tests for a point whose first number did not fit its field: Fortran writes "*****" then.
bool has_overflowed(std::string_view line) {
    return (line.starts_with('*') || line.starts_with('/')) && !has_letters(cells_of(line).front());
}

/// Wheel paths of the points as stated in the header.
enum class WheelPath : std::uint8_t { unstated, left, right, both };

/// Parses "both", "B", "LR", "L&R", "Left & Right", "LWP/RWP", "left", "L", "right", "R" in any
/// case; profilers differ.
WheelPath parse_wheel_path(std::string_view text) {
    std::string letters;
    for (const char c : text) {
        if (std::isalpha(static_cast<unsigned char>(c)) != 0) {
            letters += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        }
    }
    const auto has = [&](std::string_view part) { return letters.find(part) != std::string::npos; };
    const bool left = letters.starts_with('l') || has("left");
    const bool right = letters.starts_with('r') || has("right");
    // Between other letters "lwp" and "rwp" may be chance: "Outer WP" ends in the latter.
    if (letters == "lr" || letters == "rl" || letters == "b" || letters == "both" ||
        (left && (right || has("rwp"))) || (right && has("lwp"))) {
        return WheelPath::both;
    }
    return left ? WheelPath::left : right ? WheelPath::right : WheelPath::unstated;
}

std::vector<std::string> track_names(WheelPath path, std::size_t tracks) {
    if (tracks == 2) {
        return {"left", "right"};
    }
    return {path == WheelPath::left ? "left" : path == WheelPath::right ? "right" : "profile"};
}

/// Metres per unit of distance, which some profilers abbreviate to one letter: "3,i".
std::optional<double> metres_of_distance(std::string_view unit) {
    unit = trimmed(unit);
    return metres_in(unit == "i" || unit == "I" ? "in" : unit == "f" || unit == "F" ? "ft" : unit);
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
        head_.tracks = track_names(path_, tracks_);
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
        const auto step_unit_m =
            cells.size() < needed ? std::nullopt : metres_of_distance(cells[4]);
        if (!unit_m || (!step_m && !(step && *step > 0 && step_unit_m))) {
            throw InputError{fmt::format("{}: {}, expected maker, unit of elevation, wheel path, "
                                         "distance between points and its unit ({})",
                                         lines_.where(),
                                         in_quotes(line, 80),
                                         length_units)};
        }
        unit_m_ = *unit_m;
        path_ = parse_wheel_path(cells[2]);
        head_.step_m = step_m ? step_m : *step * *step_unit_m;
    }

    /// Reads the elevations of the next line into row_, from index 1 on. Returns false at the end.
    bool read_line() {
        auto line = lines_.next();
        while (line && is_no_point(*line)) {
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

    /// Tests for a blank line, the end of a DOS text, and a comment. Before the first point every
    /// line that does not begin with a number is a comment. A point that has overflowed is none:
    /// without it all later points would be a step too early.
    bool is_no_point(std::string_view line) const {
        const auto text = trimmed(line);
        return text.empty() || text == "\x1a" ||
               (!has_overflowed(text) &&
                (comment_marks.find(text.front()) != std::string_view::npos ||
                 (tracks_ == 0 && !parse_number(cells_of(line).front()))));
    }

    std::size_t tracks_in(const std::vector<std::string_view>& cells, std::string_view line) const {
        if (path_ != WheelPath::unstated) {
            return path_ == WheelPath::both ? 2 : 1; // comment and position may take any cells
        }
        switch (cells.size()) {
        case one_path:
            return parse_number(cells[1]) ? 2 : 1; // two elevations without a comment, or one
        case one_path_with_fix:
            return 1;
        case two_paths:
        case two_paths_with_fix:
            return 2;
        default:
            throw InputError{fmt::format("{}: {} has {} cells, expected 2 or 3 (one or two "
                                         "elevations and a comment), or five more with a position; "
                                         "or a wheel path 'L', 'R' or 'LR' in line 3",
                                         lines_.where(),
                                         in_quotes(line),
                                         cells.size())};
        }
    }

    TextLines lines_;
    ProfileHead head_;
    double unit_m_ = 0;
    WheelPath path_ = WheelPath::unstated;
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
