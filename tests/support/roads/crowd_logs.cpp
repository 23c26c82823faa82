#include "support/roads/crowd_logs.hpp"

#include "support/roads/drive.hpp"

#include <fmt/format.h>

#include <string_view>

namespace macadam::testing {
namespace {

const Drive drive{.length_m = crowd_ways * crowd_way_m};

} // namespace

std::string crowd_road_osm() {
    std::string osm{"<osm version=\"0.6\">\n"};
    for (int i = 0; i <= crowd_ways; ++i) {
        const auto place = place_of(drive, crowd_way_m * i);
        osm += fmt::format("<node id=\"{}\" lat=\"{:.7f}\" lon=\"{:.7f}\"/>\n",
                           i + 1,
                           place.lat_deg,
                           place.lon_deg);
    }
    for (int i = 1; i <= crowd_ways; ++i) {
        osm += fmt::format("<way id=\"{}\"><nd ref=\"{}\"/><nd ref=\"{}\"/>"
                           "<tag k=\"highway\" v=\"primary\"/></way>\n",
                           i,
                           i,
                           i + 1);
    }
    return osm + "</osm>\n";
}

std::vector<std::string> crowd_logs(int cars) {
    constexpr std::string_view name = "golden-car";
    const auto text = text_of(drive_over(patched_road([](double) { return false; }, 1),
                                         drive,
                                         *built_in_vehicle(std::string{name})),
                              drive);
    std::vector<std::string> logs;
    for (int number = 0; number < cars; ++number) {
        auto& log = logs.emplace_back(text);
        log.replace(log.find(name), name.size(), fmt::format("car-{}", number));
    }
    return logs;
}

} // namespace macadam::testing
