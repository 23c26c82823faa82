// open_maps LIST: opens each file of a list as a network and as a base map, as the program does,
// and says which of them it took. For tests that watch it.

#include "estimator/common/error.hpp"
#include "storage/networks/network_reader.hpp"
#include "storage/rasters/base_map_file.hpp"

#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>

namespace {

template <typename Open>
bool is_taken(const Open& open) {
    try {
        open();
        return true;
    } catch (const macadam::InputError&) {
        return false;
    }
}

} // namespace

int main(int /*argc*/, char** argv) {
    std::ifstream list{argv[1]};
    for (std::string name; std::getline(list, name);) {
        if (is_taken([&] { macadam::read_network(name); })) {
            std::cout << "network " << std::filesystem::path{name}.filename().string() << '\n';
        }
        if (is_taken([&] {
                macadam::open_base_map(name).laid_on({"", 0, 40, 10, 4, 4})({0, 0, 4, 4});
            })) {
            std::cout << "base map " << std::filesystem::path{name}.filename().string() << '\n';
        }
    }
}
