#include "storage/trips/positions/nmea_reader.hpp"

#include "estimator/common/error.hpp"
#include "storage/tables/text_lines.hpp"
#include "storage/text/text.hpp"
#include "storage/trips/log/trip_assembly.hpp"
#include "storage/trips/log/trip_row.hpp"
#include "storage/trips/positions/position_columns.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace macadam {

namespace {

// Fields of sentences: NMEA 0183 version 4.11, as documented by receiver makers, for example
// u-blox, "M8 Receiver description including protocol specification", section 31.

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr double knot_mps = 1852.0 / 3600;
constexpr double day_s = 86400;
constexpr int first_year_of_gps = 80; // of two digits: 1980; receivers without a fix state it

using Fields = std::vector<std::string_view>;

/// Fix in progress: what the sentences of one time of day say.
struct Epoch {
    double day_time_s;             ///< UTC, since midnight
    std::optional<double> day_s{}; ///< midnight, since 1970
    GeoPoint at{unknown, unknown};
    double speed_mps = unknown;
    double course_deg = unknown;
    double hdop = unknown;
    double quality = unknown; ///< GGA code: 0 none
};

/// Line of the file: the epoch that begins with it, or a reason.
struct Line {
    std::int32_t epoch; ///< -1: none
    RowReason reason;
};

/// Cuts a sentence between '$' and '*' out of a line; `std::nullopt` without a correct checksum.
std::optional<std::string_view> sentence_in(std::string_view line) {
    const auto begin = line.find('$');
    const auto star = line.find('*', begin == std::string_view::npos ? 0 : begin);
    if (begin == std::string_view::npos || star == std::string_view::npos) {
        return std::nullopt;
    }
    const auto sentence = line.substr(begin + 1, star - begin - 1);
    const auto digits = trimmed(line.substr(star + 1));
    unsigned stated = 0;
    const auto [end, error] =
        std::from_chars(digits.data(), digits.data() + digits.size(), stated, 16);
    unsigned sum = 0;
    for (const char c : sentence) {
        sum ^= static_cast<unsigned char>(c);
    }
    const bool is_whole =
        error == std::errc{} && digits.size() == 2 && end == digits.data() + digits.size();
    return is_whole && sum == stated ? std::optional{sentence} : std::nullopt;
}

Fields fields_of(std::string_view sentence) {
    Fields fields;
    for (;;) {
        const auto size = sentence.find(',');
        fields.push_back(trimmed(sentence.substr(0, size)));
        if (size == std::string_view::npos) {
            return fields;
        }
        sentence.remove_prefix(size + 1);
    }
}

/// Reads the fields of a sentence, and notes whether any is bad.
class FieldReader {
public:
    explicit FieldReader(const Fields& fields) : fields_{fields} {}

    bool is_bad() const { return bad_; }

    std::string_view text(std::size_t i) const {
        return i < fields_.size() ? fields_[i] : std::string_view{};
    }

    double number(std::size_t i) {
        if (text(i).empty()) {
            return unknown;
        }
        const auto number = parse_number(text(i));
        bad_ = bad_ || !number || !std::isfinite(*number);
        return number.value_or(unknown);
    }

    /// hhmmss.ss in seconds.
    double day_time_s(std::size_t i) {
        const double time = number(i);
        const double hours = std::floor(time / 10000);
        const double minutes = std::floor((time - hours * 10000) / 100);
        const double seconds = time - hours * 10000 - minutes * 100;
        bad_ = bad_ || time < 0 || hours > 23 || minutes > 59 || seconds >= 61;
        return hours * 3600 + minutes * 60 + seconds;
    }

    /// ddmm.mmmm and, in the next field, the hemisphere.
    double degrees(std::size_t i, std::string_view positive, std::string_view negative) {
        const double value = number(i);
        if (std::isnan(value)) {
            return unknown;
        }
        const double whole = std::floor(value / 100);
        const double minutes = value - 100 * whole;
        const auto hemisphere = text(i + 1);
        bad_ = bad_ || value < 0 || minutes >= 60 ||
               (hemisphere != positive && hemisphere != negative);
        return (hemisphere == negative ? -1 : 1) * (whole + minutes / 60);
    }

    GeoPoint place(std::size_t i) { return {degrees(i, "N", "S"), degrees(i + 2, "E", "W")}; }

    /// ddmmyy as midnight since 1970; `std::nullopt` if empty, or before any receiver was built.
    std::optional<double> date_s(std::size_t i) {
        namespace chr = std::chrono;
        const auto digits = text(i);
        if (digits.empty()) {
            return std::nullopt;
        }
        const double stated = number(i);
        if (std::isnan(stated)) {
            return std::nullopt; // noted as bad
        }
        const auto date = static_cast<int>(std::clamp(stated, -1.0, 1e6));
        const chr::year_month_day day{chr::year{2000 + date % 100},
                                      chr::month{static_cast<unsigned>(date / 100 % 100)},
                                      chr::day{static_cast<unsigned>(date / 10000)}};
        if (digits.size() != 6 || !day.ok()) {
            bad_ = true;
            return std::nullopt;
        }
        return date % 100 >= first_year_of_gps
                   ? std::nullopt
                   : std::optional{day_s * static_cast<double>(
                                               chr::sys_days{day}.time_since_epoch().count())};
    }

private:
    const Fields& fields_;
    bool bad_ = false;
};

void keep_known(double& value, double read) {
    value = std::isnan(read) ? value : read;
}

void take_rmc(FieldReader& read, Epoch& epoch) {
    const bool is_valid = read.text(2) == "A";
    const auto at = read.place(3);
    const double speed_kn = read.number(7);
    const double course_deg = read.number(8);
    const auto date_s = read.date_s(9);
    if (!is_valid) {
        epoch.quality = std::isnan(epoch.quality) ? 0 : epoch.quality;
        return;
    }
    epoch.at = std::isnan(epoch.at.lat_deg) ? at : epoch.at;
    epoch.day_s = date_s;
    keep_known(epoch.speed_mps, speed_kn * knot_mps);
    keep_known(epoch.course_deg, course_deg);
}

void take_gga(FieldReader& read, Epoch& epoch) {
    epoch.at = read.place(2);
    epoch.quality = read.number(6);
    epoch.hdop = read.number(8);
}

/// Takes what the RMC of the fix did not state: of a receiver that sends VTG first, the last one is
/// that of the next fix.
void take_vtg(FieldReader& read, Epoch& epoch) {
    const double course_deg = read.number(1);
    const double kmh = read.number(7);
    const double speed_mps = std::isnan(kmh) ? read.number(5) * knot_mps : kmh / 3.6;
    epoch.course_deg = std::isnan(epoch.course_deg) ? course_deg : epoch.course_deg;
    epoch.speed_mps = std::isnan(epoch.speed_mps) ? speed_mps : epoch.speed_mps;
}

/// Collects the fixes of a recording.
class Epochs {
public:
    void add(std::string_view line) {
        const auto sentence = sentence_in(line);
        if (!sentence) {
            lines.push_back({-1, RowReason::bad_number});
            return;
        }
        const auto fields = fields_of(*sentence);
        const auto type =
            fields.front().size() == 5 ? fields.front().substr(2) : std::string_view{};
        FieldReader read{fields};
        if (type == "VTG" && !epochs.empty()) {
            take(read, take_vtg, epochs.back(), {-1, RowReason::merged});
        } else if (type == "RMC" || type == "GGA") {
            take_timed(read, type == "RMC" ? take_rmc : take_gga);
        } else {
            lines.push_back({-1, RowReason::unused_channel});
        }
    }

    std::vector<Epoch> epochs{};
    std::vector<Line> lines{};

private:
    using Take = void (*)(FieldReader&, Epoch&);

    void take(FieldReader& read, Take taking, Epoch& into, Line line) {
        auto changed = into;
        taking(read, changed);
        if (read.is_bad()) {
            lines.push_back({-1, RowReason::bad_number});
        } else {
            into = changed;
            lines.push_back(line);
        }
    }

    void take_timed(FieldReader& read, Take taking) {
        const double time_s = read.day_time_s(1);
        if (read.is_bad()) {
            lines.push_back({-1, RowReason::bad_number});
        } else if (std::isnan(time_s)) {
            lines.push_back({-1, RowReason::no_time});
        } else if (!epochs.empty() && epochs.back().day_time_s == time_s) {
            take(read, taking, epochs.back(), {-1, RowReason::merged});
        } else {
            Epoch epoch{.day_time_s = time_s};
            take(read, taking, epoch, {static_cast<std::int32_t>(epochs.size()), {}});
            if (!read.is_bad()) {
                epochs.push_back(epoch);
            }
        }
    }
};

/// Times of the epochs, since 1970 if `dated`, else since the first midnight.
struct EpochTimes {
    std::vector<double> t_s;
    bool dated;
};

/// Dates each epoch by its RMC, otherwise by the last date and the midnights since; those before
/// the first date by that date.
EpochTimes times_of(const std::vector<Epoch>& epochs) {
    constexpr double half_day_s = day_s / 2; // a clock that jumps back by more has passed midnight
    EpochTimes times{.t_s = {}, .dated = false};
    double midnight_s = 0;
    double last_s = 0;
    for (const auto& epoch : epochs) {
        midnight_s += epoch.day_time_s < last_s - half_day_s ? day_s : 0;
        last_s = epoch.day_time_s;
        if (epoch.day_s) {
            if (!times.dated) {
                for (auto& earlier_s : times.t_s) {
                    earlier_s += *epoch.day_s - midnight_s;
                }
            }
            midnight_s = *epoch.day_s;
            times.dated = true;
        }
        times.t_s.push_back(midnight_s + epoch.day_time_s);
    }
    return times;
}

TripRow row_of(const Epoch& epoch, double t_s) {
    TripRow row;
    row.value.fill(unknown);
    const std::pair<TripColumn, double> values[] = {
        {TripColumn::t_s, t_s},
        {TripColumn::lat, epoch.at.lat_deg},
        {TripColumn::lon, epoch.at.lon_deg},
        {TripColumn::gnss_speed, epoch.speed_mps},
        {TripColumn::course, epoch.course_deg},
        {TripColumn::hacc, hacc_per_hdop_m * epoch.hdop},
        {TripColumn::gnss_fix, epoch.quality},
        {TripColumn::gnss_utc, epoch.day_time_s}};
    for (const auto& [column, value] : values) {
        row.value[static_cast<std::size_t>(column)] = value;
    }
    return row;
}

} // namespace

bool is_nmea_name(std::string_view name) {
    return name.ends_with(".nmea") || name.ends_with(".nmea.gz") || name.ends_with(".nmea.zst");
}

bool is_nmea_text(std::string_view head) {
    constexpr int max_lines = 50;
    for (int i = 0; i < max_lines && !head.empty(); ++i) {
        auto line = head.substr(0, head.find('\n'));
        head.remove_prefix(std::min(line.size() + 1, head.size()));
        line = line.ends_with('\r') ? line.substr(0, line.size() - 1) : line;
        const auto sentence = sentence_in(line);
        if (sentence && fields_of(*sentence).front().size() == 5 && sentence->find(',') == 5) {
            return true;
        }
    }
    return false;
}

TripLog
read_nmea(std::unique_ptr<ByteStream> bytes, const std::string& name, const TripNeeds& needs) {
    expect_positions_to_do(needs, name, "an NMEA recording");
    Epochs read;
    TextLines lines{std::move(bytes), name};
    while (const auto line = lines.next()) {
        if (!trimmed(*line).empty()) {
            read.add(*line);
        }
    }
    if (read.epochs.empty()) {
        throw InputError{fmt::format("{}: {} lines and no RMC or GGA sentence with a correct "
                                     "checksum, expected an NMEA 0183 recording",
                                     name,
                                     read.lines.size())};
    }
    const auto times = times_of(read.epochs);
    TripStreams streams{needs, {}};
    for (const auto& [epoch, reason] : read.lines) {
        if (epoch >= 0) {
            const auto i = static_cast<std::size_t>(epoch);
            streams.add(row_of(read.epochs[i], times.t_s[i] - times.t_s.front()));
        } else {
            TripRow row;
            row.fault = reason;
            streams.add(row);
        }
    }
    auto trip = streams.take();
    const auto stem = std::filesystem::path{name}.filename();
    trip.meta.trip_id =
        (is_nmea_name(stem.string()) && stem.extension() != ".nmea" ? stem.stem() // of .nmea.gz
                                                                    : stem)
            .stem()
            .string();
    if (times.dated) {
        trip.meta.t0_utc_s = times.t_s.front();
    }
    return trip;
}

} // namespace macadam
