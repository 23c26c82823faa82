#include "storage/store/privacy/trip_names.hpp"

#include "storage/store/privacy/privacy_key.hpp"

#include <set>

namespace macadam {

std::string without_vehicle_id(std::string_view name, std::string_view vehicle_id) {
    std::string kept;
    while (!vehicle_id.empty()) {
        const auto at = name.find(vehicle_id);
        if (at == std::string_view::npos) {
            break;
        }
        kept += name.substr(0, at);
        kept += '*';
        name.remove_prefix(at + vehicle_id.size());
    }
    return kept.append(name);
}

std::vector<NameReading> readings_of_name(std::string_view name) {
    std::set<std::string_view> texts;
    for (std::size_t from = 0; from < name.size(); ++from) {
        for (std::size_t size = 1; size <= name.size() - from; ++size) {
            texts.insert(name.substr(from, size));
        }
    }
    std::vector<NameReading> readings;
    for (const auto text : texts) {
        readings.push_back({std::string{text}, without_vehicle_id(name, text)});
    }
    return readings;
}

std::string text_of_unkeyed_name(std::string_view name, std::string_view unkeyed) {
    for (std::size_t from = 0; from < name.size(); ++from) {
        for (std::size_t size = 1; size <= name.size() - from; ++size) {
            if (is_unkeyed_name_of(unkeyed, name.substr(from, size))) {
                return std::string{name.substr(from, size)};
            }
        }
    }
    return {};
}

} // namespace macadam
