#include "shell.hpp"

#include <cstdlib>
#include <fstream>
#include <iterator>

namespace macadam::testing {

std::string content_of(const std::filesystem::path& file) {
    std::ifstream in{file, std::ios::binary};
    return {std::istreambuf_iterator<char>{in}, {}};
}

std::string output_of(const std::filesystem::path& folder, const std::string& command) {
    const auto log = folder / "output.txt";
    const int status = std::system((command + " >" + log.string() + " 2>&1").c_str());
    return content_of(log) + (status == 0 ? "" : "\nexit " + std::to_string(status));
}

} // namespace macadam::testing
