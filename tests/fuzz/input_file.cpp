#include "input_file.hpp"

#include <algorithm>
#include <fstream>
#include <system_error>

#include <unistd.h>

namespace macadam::fuzz {
namespace {

namespace fs = std::filesystem;

struct Folder {
    fs::path path = fs::temp_directory_path() / ("macadam_fuzz_" + std::to_string(getpid()));

    ~Folder() {
        std::error_code gone_already;
        fs::remove_all(path, gone_already);
    }
};

const fs::path& emptied_folder() {
    static const Folder folder;
    fs::create_directories(folder.path);
    for (const auto& left : fs::directory_iterator{folder.path}) {
        fs::remove_all(left);
    }
    return folder.path;
}

void write(const fs::path& file, std::string_view content) {
    fs::create_directories(file.parent_path());
    std::ofstream{file, std::ios::binary} << content;
}

} // namespace

fs::path input_file(const std::string& name, std::string_view content) {
    auto file = emptied_folder() / name;
    write(file, content);
    return file;
}

fs::path input_folder(std::span<const std::string_view> names, std::string_view parts) {
    constexpr std::string_view mark = "=== ";
    auto folder = emptied_folder() / "input";
    fs::create_directories(folder);
    while (parts.starts_with(mark)) {
        const auto end = std::min(parts.find("\n=== "), parts.size() - 1) + 1;
        const auto part = parts.substr(mark.size(), end - mark.size());
        const auto name = part.substr(0, part.find('\n'));
        if (name.size() < part.size() && std::ranges::find(names, name) != names.end()) {
            write(folder / name, part.substr(name.size() + 1));
        }
        parts.remove_prefix(end);
    }
    return folder;
}

} // namespace macadam::fuzz
