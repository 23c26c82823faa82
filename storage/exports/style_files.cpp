#include "storage/exports/style_files.hpp"

#include "storage/atomic/atomic_file.hpp"
#include "storage/styles/road_style.hpp"

#include <array>
#include <fstream>
#include <string>
#include <string_view>

namespace macadam {
namespace {

constexpr std::string_view mark =
    "<!-- Written by Macadam; a style saved in its place stays. -->\n";

/// Tests whether a file is another's: it exists and does not end with the mark.
bool is_of_others(const std::filesystem::path& file) {
    std::ifstream in{file, std::ios::binary | std::ios::ate};
    if (!in) {
        return std::filesystem::exists(file);
    }
    std::array<char, mark.size()> end{};
    in.seekg(-static_cast<std::streamoff>(mark.size()), std::ios::end);
    in.read(end.data(), end.size());
    return !in || std::string_view{end.data(), end.size()} != mark;
}

void write_style(std::filesystem::path file, const char* suffix, const std::string& text) {
    file.replace_extension(suffix);
    if (is_of_others(file)) {
        return;
    }
    AtomicFile out{file};
    out.write(text);
    out.write(mark);
    out.commit();
}

} // namespace

void write_style_files(const std::filesystem::path& layer, const ClassTable& classes) {
    write_style(layer, ".qml", qml_style(classes));
    write_style(layer, ".sld", sld_style(classes, layer.stem().string()));
}

} // namespace macadam
