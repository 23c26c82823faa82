#include "fuzz/target_files.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>

namespace macadam::fuzz {
namespace {

namespace fs = std::filesystem;

const fs::path folder = MACADAM_SOURCE_DIR "/tests/fuzz";

std::string content_of(const fs::path& file) {
    std::ifstream in{file, std::ios::binary};
    return {std::istreambuf_iterator<char>{in}, {}};
}

std::vector<TargetFile> files_in(const fs::path& where) {
    std::vector<TargetFile> files;
    if (fs::exists(where)) {
        for (const auto& entry : fs::directory_iterator{where}) {
            files.push_back({entry.path().filename().string(), content_of(entry.path())});
        }
    }
    std::ranges::sort(files, {}, &TargetFile::name);
    return files;
}

/// What the pattern's first group matches in every line, sorted.
std::vector<std::string> names_in(const fs::path& file, const char* pattern) {
    const std::regex line_with_name{pattern};
    std::vector<std::string> names;
    std::ifstream in{file};
    for (std::string line; std::getline(in, line);) {
        if (std::smatch found; std::regex_search(line, found, line_with_name)) {
            names.push_back(found[1]);
        }
    }
    std::ranges::sort(names);
    return names;
}

/// A dictionary writes bytes as \xAB, and \\ and \".
std::string unescaped(std::string_view text) {
    std::string bytes;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '\\') {
            bytes += text[i];
        } else if (text.substr(i + 1, 1) == "x") {
            int byte = 0;
            std::from_chars(text.data() + i + 2, text.data() + i + 4, byte, 16);
            bytes += static_cast<char>(byte);
            i += 3;
        } else {
            bytes += text[++i];
        }
    }
    return bytes;
}

} // namespace

std::vector<TargetFile> seeds_of(std::string_view target) {
    return files_in(folder / "seeds" / target);
}

std::vector<TargetFile> findings_of(std::string_view target) {
    return files_in(folder / "findings" / target);
}

std::vector<std::string> words_of(std::string_view target) {
    auto words = names_in(folder / "dictionaries" / (std::string{target} + ".dict"),
                          R"(^[^#"]*"(.*)\"\s*$)");
    std::ranges::transform(words, words.begin(), unescaped);
    return words;
}

std::vector<std::string> declared_targets() {
    return names_in(folder / "targets.hpp", R"(^Answer ([a-z_]+)\()");
}

std::vector<std::string> targets_with_readers() {
    return names_in(folder / "readers.txt", R"(^([a-z_]+):)");
}

} // namespace macadam::fuzz
