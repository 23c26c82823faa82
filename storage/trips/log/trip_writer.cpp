#include "storage/trips/log/trip_writer.hpp"

#include "estimator/common/error.hpp"
#include "storage/files/compressed_file.hpp"
#include "storage/trips/log/trip_meta.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

namespace macadam {

namespace {

constexpr std::array<std::string_view, 3> suffixes{".trip.csv", ".trip.csv.gz", ".trip.csv.zst"};

constexpr std::size_t block_bytes = 1 << 18;
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

struct Column {
    std::string_view name;
    int decimals;
};

// Columns in the order of the cells of a row.
constexpr Column time_column{"t_s", 6};
constexpr std::array columns{Column{"acc_x_mps2", 5},
                             Column{"acc_y_mps2", 5},
                             Column{"acc_z_mps2", 5},
                             Column{"gyro_x_radps", 6},
                             Column{"gyro_y_radps", 6},
                             Column{"gyro_z_radps", 6},
                             Column{"speed_mps", 4},
                             Column{"lat_deg", 8},
                             Column{"lon_deg", 8},
                             Column{"gnss_speed_mps", 4},
                             Column{"course_deg", 4},
                             Column{"hacc_m", 3},
                             Column{"gnss_utc_s", 6}};
constexpr std::size_t first_gyro = 3;
constexpr std::size_t speed_cell = 6;
constexpr std::size_t first_fix = 7;
constexpr std::size_t utc_cell = 12;

using Cells = std::array<double, columns.size()>; ///< NaN: empty

std::int64_t units(double value, int decimals) {
    static constexpr std::array<double, 9> per_one{1, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8};
    return std::llround(value * per_one[static_cast<std::size_t>(decimals)]);
}

/// Appends the same text as "{:.{}f}", faster: formatting an integer is cheaper than formatting a
/// double.
void append_fixed(std::string& to, double value, int decimals) {
    constexpr double most = 9e9; // the scaled value fits 64 bits
    if (!(std::abs(value) < most)) {
        to += fmt::format("{:.{}f}", value, decimals);
        return;
    }
    const auto whole = units(value, decimals);
    std::array<char, 24> digits;
    const auto* const end =
        std::to_chars(digits.begin(), digits.end(), whole < 0 ? -whole : whole).ptr;
    const auto count = static_cast<std::size_t>(end - digits.data());
    const auto fraction = static_cast<std::size_t>(decimals);
    if (whole < 0) {
        to += '-';
    }
    if (count <= fraction) {
        to += "0.";
        to.append(fraction - count, '0').append(digits.data(), count);
    } else {
        to.append(digits.data(), count - fraction).append(1, '.');
        to.append(end - fraction, fraction);
    }
}

/// Time stamp at the resolution of the log.
std::int64_t stamp(double t_s) {
    return units(t_s, time_column.decimals);
}

bool print_the_same(double a, double b, int decimals) {
    return std::isnan(a) || std::isnan(b) ? std::isnan(a) == std::isnan(b)
                                          : units(a, decimals) == units(b, decimals);
}

bool print_the_same(const GnssFix& a, const GnssFix& b) {
    return print_the_same(a.at.lat_deg, b.at.lat_deg, columns[first_fix].decimals) &&
           print_the_same(a.at.lon_deg, b.at.lon_deg, columns[first_fix + 1].decimals) &&
           print_the_same(a.speed_mps, b.speed_mps, columns[first_fix + 2].decimals) &&
           print_the_same(a.course_deg, b.course_deg, columns[first_fix + 3].decimals);
}

/// Iterates over the rows of a trip, each with the samples of its time.
class Rows {
public:
    explicit Rows(const TripLog& trip)
        : trip_{trip}, t0_s_{trip.meta.t0_utc_s.value_or(0)},
          fixes_look_alike_{
              std::ranges::adjacent_find(trip.fixes, [](const auto& a, const auto& b) {
                  return print_the_same(a, b);
              }) != trip.fixes.end()} {}

    /// \returns false at the end.
    bool next() {
        at_ = std::min({stamp_at(trip_.acc.t_s, acc_),
                        stamp_at(trip_.gyro.t_s, gyro_),
                        stamp_at(trip_.speed.t_s, speed_),
                        fix_ < trip_.fixes.size() ? stamp(trip_.fixes[fix_].t_s) : none});
        if (at_ == none) {
            return false;
        }
        cells_.fill(unknown);
        take(trip_.acc, acc_, 0);
        take(trip_.gyro, gyro_, first_gyro);
        if (stamp_at(trip_.speed.t_s, speed_) == at_) {
            t_s_ = trip_.speed.t_s[speed_];
            cells_[speed_cell] = trip_.speed.speed_mps[speed_++];
        }
        take_fix();
        return true;
    }

    double t_s() const { return t_s_; }
    const Cells& cells() const { return cells_; }

private:
    static constexpr std::int64_t none = std::numeric_limits<std::int64_t>::max();

    static std::int64_t stamp_at(const std::vector<double>& t_s, std::size_t i) {
        return i < t_s.size() ? stamp(t_s[i]) : none;
    }

    void take(const TriaxialSamples& from, std::size_t& i, std::size_t cell) {
        if (stamp_at(from.t_s, i) == at_) {
            t_s_ = from.t_s[i];
            cells_[cell] = from.x[i];
            cells_[cell + 1] = from.y[i];
            cells_[cell + 2] = from.z[i];
            ++i;
        }
    }

    void take_fix() {
        if (fix_ == trip_.fixes.size() || stamp(trip_.fixes[fix_].t_s) != at_) {
            return;
        }
        const auto& fix = trip_.fixes[fix_++];
        t_s_ = fix.t_s;
        cells_[first_fix] = fix.at.lat_deg;
        cells_[first_fix + 1] = fix.at.lon_deg;
        cells_[first_fix + 2] = fix.speed_mps;
        cells_[first_fix + 3] = fix.course_deg;
        cells_[first_fix + 4] = fix.accuracy_m;
        // as it will be read from the rounded time
        cells_[utc_cell] = fixes_look_alike_ ? t0_s_ + static_cast<double>(at_) / 1e6 : unknown;
    }

    const TripLog& trip_;
    double t0_s_;
    bool fixes_look_alike_;
    std::size_t acc_ = 0;
    std::size_t gyro_ = 0;
    std::size_t speed_ = 0;
    std::size_t fix_ = 0;
    std::int64_t at_ = none;
    double t_s_ = 0;
    Cells cells_{};
};

using Occurring = std::array<bool, columns.size()>;

Occurring columns_of(const TripLog& trip) {
    Occurring occurring{};
    for (Rows rows{trip}; rows.next();) {
        for (std::size_t i = 0; i < columns.size(); ++i) {
            occurring[i] = occurring[i] || !std::isnan(rows.cells()[i]);
        }
    }
    return occurring;
}

std::string header(const Occurring& occurring) {
    std::string line{time_column.name};
    for (std::size_t i = 0; i < columns.size(); ++i) {
        if (occurring[i]) {
            line.append(1, ',').append(columns[i].name);
        }
    }
    return line + "\n";
}

void append_row(std::string& to, const Rows& rows, const Occurring& occurring) {
    append_fixed(to, rows.t_s(), time_column.decimals);
    for (std::size_t i = 0; i < columns.size(); ++i) {
        if (!occurring[i]) {
            continue;
        }
        to += ',';
        if (const double value = rows.cells()[i]; !std::isnan(value)) {
            append_fixed(to, value, columns[i].decimals);
        }
    }
    to += '\n';
}

void expect_suffix(const std::filesystem::path& file) {
    const auto name = file.filename().string();
    if (std::ranges::none_of(suffixes, [&](auto suffix) { return name.ends_with(suffix); })) {
        throw InputError{fmt::format(
            "{}: expected a name that ends in {}", file.string(), fmt::join(suffixes, ", "))};
    }
}

void stop_if_wanted(const std::stop_token& stop, const std::filesystem::path& file) {
    if (stop.stop_requested()) {
        throw InputError{fmt::format("{}: stopped before it was complete", file.string())};
    }
}

} // namespace

std::size_t write_trip(const TripLog& trip,
                       const std::filesystem::path& file,
                       int level,
                       const std::stop_token& stop) {
    expect_suffix(file);
    CompressedFile out{file, compression_of(file), level};
    const auto occurring = columns_of(trip);

    std::string block = "# macadam-trip 1\n" + meta_text(trip.meta) + header(occurring);
    std::size_t count = 0;
    for (Rows rows{trip}; rows.next(); ++count) {
        append_row(block, rows, occurring);
        if (block.size() >= block_bytes) {
            out.write(block);
            block.clear();
            stop_if_wanted(stop, file);
        }
    }
    out.write(block + fmt::format("# end rows: {}\n", count));
    out.commit();
    return count;
}

} // namespace macadam
