#include "road_art.hpp"
#include "mapping/network/build_network.hpp"

#include "mapping/network/network_records.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

namespace macadam::testing {
namespace {

constexpr GeoPoint corner{45.75, 4.85};
constexpr double m_per_deg_lat = 111150; // about, here
constexpr double m_per_deg_lon = 77830;

std::map<char, GeoPoint> places_in(std::string_view art, double cell_m) {
    std::map<char, GeoPoint> places;
    int column = 0;
    int row = 0;
    for (const char c : art) {
        if (c == '\n') {
            column = 0;
            ++row;
            continue;
        }
        const GeoPoint drawn{corner.lat_deg - 2 * row * cell_m / m_per_deg_lat,
                             corner.lon_deg + column * cell_m / m_per_deg_lon};
        const auto at = Unpacked{}(packed(drawn)); // where a network can hold it
        if (std::isalpha(static_cast<unsigned char>(c)) != 0 && !places.emplace(c, at).second) {
            throw std::logic_error{"letter drawn twice"};
        }
        ++column;
    }
    return places;
}

/// Where a car is that went `gone_m` along the line, and its course.
struct OnLine {
    GeoPoint at;
    double course;
};

OnLine along(const std::vector<GeoPoint>& line, double gone_m) {
    for (std::size_t i = 1; i < line.size(); ++i) {
        const double step_m = distance_m(line[i - 1], line[i]);
        if (gone_m <= step_m || i + 1 == line.size()) {
            return {between(line[i - 1], line[i], std::min(1.0, gone_m / step_m)),
                    course_deg(line[i - 1], line[i])};
        }
        gone_m -= step_m;
    }
    return {line.front(), 0};
}

double length_of(const std::vector<GeoPoint>& line) {
    double sum_m = 0;
    for (std::size_t i = 1; i < line.size(); ++i) {
        sum_m += distance_m(line[i - 1], line[i]);
    }
    return sum_m;
}

} // namespace

RoadArt road_art(std::string_view art, double cell_m, const std::vector<std::string>& roads) {
    RoadArt result{{}, {}, places_in(art, cell_m)};
    for (const auto& road : roads) {
        Way way{static_cast<std::int64_t>(result.ways.size() + 1), road, "", Oneway::no, {}, {}};
        for (const char letter : road) {
            if (letter == '>' || letter == '<') {
                way.oneway = letter == '>' ? Oneway::forward : Oneway::backward;
                continue;
            }
            way.node_ids.push_back(letter);
            way.line.push_back(result.places.at(letter));
        }
        result.ways.push_back(std::move(way));
    }
    result.roads = build_network(result.ways);
    return result;
}

EdgeId edge_between(const RoadArt& art, char from, char to) {
    for (std::uint32_t i = 0; i < link_count(art.roads); ++i) {
        const auto link = link_at(art.roads, LinkId{i});
        const auto ids = way_at(art.roads, link.way).node_ids;
        for (auto point = link.first_point; point < link.last_point; ++point) {
            if (ids[point] == from && ids[point + 1] == to) {
                return edge_of(LinkId{i}, true);
            }
            if (ids[point] == to && ids[point + 1] == from) {
                return edge_of(LinkId{i}, false);
            }
        }
    }
    throw std::logic_error{"no road joins these letters"};
}

std::vector<GeoPoint> line_through(const RoadArt& art, std::string_view letters) {
    std::vector<GeoPoint> line;
    for (std::size_t i = 0; i < letters.size(); ++i) {
        const auto is_share = [&](std::size_t k) {
            return k < letters.size() && std::isdigit(static_cast<unsigned char>(letters[k])) != 0;
        };
        const auto share = [&](std::size_t k) { return (letters[k] - '0') / 10.0; };
        if (is_share(i)) {
            continue;
        }
        auto at = art.places.at(letters[i]);
        if (i == 0 && is_share(1)) {
            at = between(at, art.places.at(letters[2]), share(1));
        } else if (i + 1 == letters.size() && i > 2 && is_share(i - 1)) {
            at = between(art.places.at(letters[i - 2]), at, share(i - 1));
        }
        line.push_back(at);
    }
    return line;
}

TripLog drive(const std::vector<GeoPoint>& line, const DriveConfig& config) {
    constexpr auto unknown = std::numeric_limits<float>::quiet_NaN();
    std::mt19937_64 random{config.seed};
    std::normal_distribution<double> noise{0, 1};
    const double long_s = length_of(line) / config.speed_mps;
    TripLog trip;
    for (int k = 0; k * config.fix_step_s <= long_s + 1e-9; ++k) {
        const double t_s = k * config.fix_step_s;
        const auto [at, course] = along(line, t_s * config.speed_mps);
        const GeoPoint seen{at.lat_deg + config.noise_m * noise(random) / m_per_deg_lat,
                            at.lon_deg + config.noise_m * noise(random) / m_per_deg_lon};
        trip.fixes.push_back({t_s,
                              seen,
                              config.courses ? static_cast<float>(config.speed_mps) : unknown,
                              config.courses ? static_cast<float>(course) : unknown,
                              unknown});
    }
    for (int k = 0; config.speeds && k * 0.1 <= long_s + 0.1; ++k) {
        trip.speed.t_s.push_back(k * 0.1);
        trip.speed.speed_mps.push_back(static_cast<float>(config.speed_mps));
    }
    return trip;
}

} // namespace macadam::testing
