#include "storage/trips/positions/gpx_reader.hpp"

#include "estimator/common/error.hpp"
#include "storage/text/text.hpp"
#include "storage/text/utc.hpp"
#include "storage/trips/log/trip_assembly.hpp"
#include "storage/trips/log/trip_row.hpp"
#include "storage/trips/positions/position_columns.hpp"

#include <expat.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace macadam {

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t longest_text = 64;    // bytes of an element; times and numbers are shorter
constexpr std::size_t deepest_element = 64; // GPX needs 5 levels, extensions a few more
constexpr std::size_t block = 1 << 16;
constexpr double likely_utc_s = 631152000; // 1990-01-01; earlier dates are invented by programs

// Parameters of made-up times.
constexpr double speed_mps = 10;
constexpr double min_step_s = 0.1; // between points at the same position
constexpr double between_segments_s = 60;

/// Track point as in the file.
struct Point {
    GeoPoint at{unknown, unknown};
    double t_s = unknown;
    double speed_mps = unknown;
    double course_deg = unknown;
    double accuracy_m = unknown;
    double hdop = unknown;
    bool bad_number = false;
};

using Segment = std::vector<Point>;

struct Content {
    std::vector<Segment> segments;
    std::size_t tracks = 0;
    std::size_t routes = 0;
    std::size_t way_points = 0;
};

/// Local part of a qualified name.
std::string_view local(std::string_view name) {
    const auto colon = name.rfind(':');
    return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

/// Seconds since 1970 of a time with "Z", "+hh:mm" or no zone, which means UTC.
std::optional<double> time_s(std::string_view text) {
    constexpr std::size_t date_size = 11; // "2015-02-06T"
    text = trimmed(text);
    const auto clock = text.substr(0, text.find_first_of("Z+-", date_size));
    const auto zone = text.substr(clock.size());
    const auto utc_s = parse_utc_s(std::string{clock} + 'Z');
    if (zone.empty() || zone == "Z") {
        return utc_s;
    }
    const auto hours = parse_number(zone.substr(1, 2));
    const auto minutes = zone.size() == 6 ? parse_number(zone.substr(4)) : std::nullopt;
    if (!utc_s || !hours || !minutes) {
        return std::nullopt;
    }
    return *utc_s - (zone.starts_with('-') ? -60 : 60) * (60 * *hours + *minutes);
}

/// Extracts the track points from XML that arrives in blocks.
class GpxParser {
public:
    explicit GpxParser(std::string name)
        : name_{std::move(name)}, parser_{XML_ParserCreate(nullptr), XML_ParserFree} {
        XML_SetUserData(parser_.get(), this);
        XML_SetElementHandler(parser_.get(), on_start, on_end);
        XML_SetCharacterDataHandler(parser_.get(), on_text);
        XML_SetEntityDeclHandler(parser_.get(), on_entity);
    }

    void add(std::string_view bytes, bool is_last) {
        const auto status =
            XML_Parse(parser_.get(), bytes.data(), static_cast<int>(bytes.size()), is_last ? 1 : 0);
        if (refusal_) {
            throw InputError{*refusal_};
        }
        if (status == XML_STATUS_ERROR) {
            throw InputError{fmt::format("{}: {}, expected a GPX file",
                                         where(),
                                         XML_ErrorString(XML_GetErrorCode(parser_.get())))};
        }
    }

    std::string where() const {
        return fmt::format("{}:{}", name_, XML_GetCurrentLineNumber(parser_.get()));
    }

    Content take() { return std::move(content_); }

private:
    static GpxParser& self(void* data) { return *static_cast<GpxParser*>(data); }

    static void on_start(void* data, const XML_Char* name, const XML_Char** attributes) {
        self(data).start(local(name), attributes);
    }
    static void on_end(void* data, const XML_Char* name) { self(data).end(local(name)); }
    static void on_text(void* data, const XML_Char* text, int size) {
        auto& kept = self(data).text_;
        const auto room = longest_text - std::min(longest_text, kept.size());
        kept.append(text, std::min(room, static_cast<std::size_t>(size)));
    }
    static void on_entity(void* data,
                          const XML_Char* name,
                          int,
                          const XML_Char*,
                          int,
                          const XML_Char*,
                          const XML_Char*,
                          const XML_Char*,
                          const XML_Char*) {
        self(data).refuse(
            fmt::format("declares the entity {}, expected a file without any", in_quotes(name)));
    }

    /// Stops the parser, because exceptions must not pass through the C library; `add` then throws.
    void refuse(std::string_view words) {
        if (!refusal_) {
            refusal_ = fmt::format("{}: {}", where(), words);
            XML_StopParser(parser_.get(), XML_FALSE);
        }
    }

    void start(std::string_view name, const XML_Char** attributes) {
        text_.clear();
        if (++depth_ > deepest_element) {
            refuse(fmt::format("{} is nested more than {} elements deep, expected a GPX file",
                               in_quotes(name),
                               deepest_element));
        } else if (depth_ == 1 && name != "gpx") {
            refuse(fmt::format("{} is the root, expected a GPX file, whose root is 'gpx'",
                               in_quotes(name)));
        } else if (depth_ == 2) {
            content_.tracks += name == "trk" ? 1 : 0;
            content_.routes += name == "rte" ? 1 : 0;
            content_.way_points += name == "wpt" ? 1 : 0;
        } else if (point_depth_ > 0) {
            return; // elements inside a point are not tracks
        } else if (name == "trkseg") {
            content_.segments.emplace_back();
        } else if (name == "trkpt" && !content_.segments.empty()) {
            content_.segments.back().push_back(placed(attributes));
            point_depth_ = depth_;
        }
    }

    static Point placed(const XML_Char** attributes) {
        Point point;
        for (; *attributes != nullptr; attributes += 2) {
            const std::string_view name{attributes[0]};
            if (name == "lat" || name == "lon") {
                const auto number = parse_number(attributes[1]);
                (name == "lat" ? point.at.lat_deg : point.at.lon_deg) = number.value_or(unknown);
                point.bad_number = point.bad_number || !number;
            }
        }
        return point;
    }

    void end(std::string_view name) {
        if (depth_ == point_depth_) {
            point_depth_ = 0;
        } else if (point_depth_ > 0) {
            fill(content_.segments.back().back(), name);
        }
        --depth_;
        text_.clear();
    }

    void fill(Point& point, std::string_view name) const {
        const std::pair<std::string_view, double&> numbers[] = {{"speed", point.speed_mps},
                                                                {"course", point.course_deg},
                                                                {"bearing", point.course_deg},
                                                                {"accuracy", point.accuracy_m},
                                                                {"hdop", point.hdop}};
        for (const auto& [known, value] : numbers) {
            if (name == known && !trimmed(text_).empty()) {
                const auto number = parse_number(text_);
                value = number.value_or(unknown);
                point.bad_number = point.bad_number || !number;
            }
        }
        if (name == "time") {
            point.t_s = time_s(text_).value_or(unknown);
        }
    }

    std::string name_;
    std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser_;
    Content content_;
    std::string text_;
    std::size_t depth_ = 0;
    std::size_t point_depth_ = 0; ///< of the open track point; 0: none
    std::optional<std::string> refusal_;
};

/// Describes the content of a file without track points.
std::string words_of(const Content& content) {
    const auto counted = [](std::size_t count, std::string_view one) {
        return fmt::format("{} {}{}", count, one, count == 1 ? "" : "s");
    };
    std::vector<std::string> words;
    const std::pair<std::size_t, std::string_view> held[] = {{content.tracks, "track"},
                                                             {content.segments.size(), "segment"},
                                                             {content.routes, "route"},
                                                             {content.way_points, "way point"}};
    for (const auto& [count, one] : held) {
        if (count > 0) {
            words.push_back(counted(count, one));
        }
    }
    return words.empty() ? "nothing" : fmt::format("{} only", fmt::join(words, ", "));
}

std::vector<Segment> parsed(ByteStream& bytes, const std::string& name) {
    GpxParser parser{name};
    std::vector<char> buffer(block);
    for (bool is_last = false; !is_last;) {
        const auto count = bytes.read(buffer);
        is_last = count == 0;
        parser.add({buffer.data(), count}, is_last);
    }
    const auto where = parser.where();
    auto content = parser.take();
    const auto held = words_of(content);
    std::erase_if(content.segments, [](const Segment& segment) { return segment.empty(); });
    if (content.segments.empty()) {
        throw InputError{fmt::format(
            "{}: contains {}, expected a track (trk) with points (trkpt)", where, held)};
    }
    return std::move(content.segments);
}

double first_time(const Segment& segment) {
    for (const auto& point : segment) {
        if (!std::isnan(point.t_s)) {
            return point.t_s;
        }
    }
    return -std::numeric_limits<double>::infinity();
}

/// Tests whether the times are usable: at least half of the steps between points take time.
bool times_tell(const std::vector<Segment>& segments) {
    std::size_t steps = 0;
    std::size_t rising = 0;
    for (const auto& segment : segments) {
        for (std::size_t i = 1; i < segment.size(); ++i) {
            ++steps;
            rising += segment[i].t_s > segment[i - 1].t_s ? 1 : 0;
        }
    }
    return rising > 0 && 2 * rising >= steps;
}

void make_up_times(std::vector<Segment>& segments) {
    double t_s = 0;
    std::optional<GeoPoint> last;
    for (auto& segment : segments) {
        for (auto& point : segment) {
            const bool has_place = std::isfinite(point.at.lat_deg + point.at.lon_deg);
            if (last && has_place) {
                t_s += std::max(min_step_s, distance_m(*last, point.at) / speed_mps);
            }
            point.t_s = t_s;
            last = has_place ? point.at : last;
        }
        t_s += between_segments_s;
    }
}

TripRow row_of(const Point& point, double zero_s) {
    TripRow row;
    row.value.fill(unknown);
    const auto set = [&](TripColumn column, double value) {
        row.value[static_cast<std::size_t>(column)] = value;
    };
    set(TripColumn::t_s, point.t_s - zero_s);
    set(TripColumn::lat, point.at.lat_deg);
    set(TripColumn::lon, point.at.lon_deg);
    set(TripColumn::gnss_speed, point.speed_mps);
    set(TripColumn::course, point.course_deg);
    set(TripColumn::hacc,
        std::isnan(point.accuracy_m) ? hacc_per_hdop_m * point.hdop : point.accuracy_m);
    if (point.bad_number) {
        row.fault = RowReason::bad_number;
    }
    return row;
}

std::string without_suffixes(const std::string& name) {
    const auto file = std::filesystem::path{name}.filename().string();
    return file.substr(0, file.rfind(".gpx"));
}

} // namespace

bool is_gpx_name(std::string_view name) {
    return name.ends_with(".gpx") || name.ends_with(".gpx.gz") || name.ends_with(".gpx.zst");
}

TripLog
read_gpx(std::unique_ptr<ByteStream> bytes, const std::string& name, const TripNeeds& needs) {
    expect_positions_to_do(needs, name, "a GPX track");
    auto segments = parsed(*bytes, name);
    TripMeta meta;
    meta.trip_id = without_suffixes(name);
    double zero_s = 0;
    if (times_tell(segments)) {
        std::ranges::stable_sort(segments, {}, first_time);
        for (auto segment = segments.rbegin(); segment != segments.rend(); ++segment) {
            zero_s = std::isfinite(first_time(*segment)) ? first_time(*segment) : zero_s;
        }
        if (zero_s > likely_utc_s) {
            meta.t0_utc_s = zero_s;
        }
    } else {
        make_up_times(segments);
        meta.other[times_key] = fmt::format("made up at {:g} m/s", speed_mps);
    }
    TripStreams streams{needs, {}};
    for (const auto& segment : segments) {
        for (const auto& point : segment) {
            streams.add(row_of(point, zero_s));
        }
    }
    auto trip = streams.take();
    trip.meta = std::move(meta);
    return trip;
}

} // namespace macadam
