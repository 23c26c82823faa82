#include "reference_data.hpp"
#include "support/program/places.hpp"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <stdexcept>

namespace macadam::testing {
namespace {

std::vector<double> numbers_of(const std::string& line) {
    std::vector<double> numbers;
    std::size_t begin = 0;
    while (begin < line.size()) {
        const auto end = std::min(line.find_first_of(", ", begin), line.size());
        const auto cell = line.substr(begin, end - begin);
        char* rest = nullptr;
        const double value = std::strtod(cell.c_str(), &rest);
        numbers.push_back(cell.empty() || *rest != '\0' ? std::nan("") : value);
        begin = end + 1;
    }
    return numbers;
}

Road road_of(const std::string& name) {
    const auto table = read_table(name, 0);
    return {column(table, 0), column(table, 1)};
}

} // namespace

std::vector<std::vector<double>> read_table(const std::string& name, int skip) {
    std::ifstream in{source_folder() + "/tests/data/" + name};
    if (!in) {
        throw std::runtime_error{"cannot open tests/data/" + name};
    }
    std::vector<std::vector<double>> table;
    for (std::string line; std::getline(in, line);) {
        line.erase(line.find_last_not_of(" \r") + 1);
        if (skip-- <= 0) {
            table.push_back(numbers_of(line));
        }
    }
    return table;
}

std::vector<double> column(const std::vector<std::vector<double>>& table, std::size_t index) {
    std::vector<double> values;
    for (const auto& row : table) {
        values.push_back(row.at(index));
    }
    return values;
}

Road sorel_even() {
    return road_of("sorel/profile_1.txt");
}

Road sorel_uneven() {
    return road_of("sorel/profile_2.txt");
}

Road starting_at(const Road& road, double from_m) {
    Road part;
    for (std::size_t i = 0; i < road.station_m.size(); ++i) {
        if (road.station_m[i] >= from_m) {
            part.station_m.push_back(road.station_m[i]);
            part.elevation_m.push_back(road.elevation_m[i]);
        }
    }
    return part;
}

} // namespace macadam::testing
