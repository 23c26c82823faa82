#include "storage/exports/style_files.hpp"

#include "estimator/common/error.hpp"
#include "storage/atomic/atomic_file.hpp"

#include <fmt/format.h>

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

/// A style file by its suffix.
struct StyleFile {
    const char* suffix;
    std::string text;
};

} // namespace

void write_style_files(const std::filesystem::path& layer,
                       const std::filesystem::path& folder,
                       const RoadStyle& style) {
    for (const auto& [suffix, text] :
         {StyleFile{".qml", qml_style(style)},
          StyleFile{".sld", sld_style(style, layer.stem().string())}}) {
        auto place = layer;
        place.replace_extension(suffix);
        if (is_of_others(place)) {
            continue;
        }
        try {
            AtomicFile out{folder / place.filename()};
            out.write(text);
            out.write(mark);
            out.commit();
        } catch (const InputError&) {
            throw InputError{
                fmt::format("{}: cannot be written with its style {}; the disk may be full",
                            layer.string(),
                            suffix)};
        }
    }
}

} // namespace macadam
