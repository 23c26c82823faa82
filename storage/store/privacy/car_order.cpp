#include "storage/store/privacy/car_order.hpp"

namespace macadam {

std::vector<std::string> read_cars(Database& database) {
    auto select =
        database.prepare("SELECT pseudonym FROM vehicle LEFT JOIN trip ON trip.vehicle = vehicle.id"
                         " GROUP BY vehicle.id ORDER BY pseudonym = 'unknown',"
                         " min(t0_utc_ms) IS NULL, min(t0_utc_ms), min(sha256)");
    std::vector<std::string> cars;
    while (select.step()) {
        cars.push_back(select.text(0));
    }
    return cars;
}

std::map<std::string, std::size_t> places_of_cars(std::span<const std::string> cars) {
    std::map<std::string, std::size_t> places;
    for (std::size_t i = 0; i < cars.size(); ++i) {
        places.emplace(cars[i], i);
    }
    return places;
}

} // namespace macadam
