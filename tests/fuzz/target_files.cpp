#include "target_files.hpp"
#include "support/program/places.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <utility>

namespace macadam::fuzz {
namespace {

namespace fs = std::filesystem;

const fs::path folder = testing::source_folder() + "/tests/fuzz";

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

std::vector<std::string> lines_of(const fs::path& file) {
    std::vector<std::string> lines;
    std::ifstream in{file};
    for (std::string line; std::getline(in, line);) {
        lines.push_back(std::move(line));
    }
    return lines;
}

/// What stands between `before`, at the beginning of a line, and `after`; sorted.
std::vector<std::string>
names_in(const fs::path& file, std::string_view before, std::string_view after) {
    std::vector<std::string> names;
    for (const auto& line : lines_of(file)) {
        const auto end = line.find(after);
        if (line.starts_with(before) && !line.starts_with('#') && end != std::string::npos) {
            names.push_back(line.substr(before.size(), end - before.size()));
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
    std::vector<std::string> words;
    for (const auto& line : lines_of(folder / "dictionaries" / (std::string{target} + ".dict"))) {
        const auto begin = line.find('"'), end = line.rfind('"');
        if (!line.starts_with('#') && begin < end) {
            words.push_back(unescaped(std::string_view{line}.substr(begin + 1, end - begin - 1)));
        }
    }
    return words;
}

std::vector<std::string> declared_targets() {
    return names_in(folder / "targets.hpp", "Answer ", "(");
}

std::vector<std::string> targets_with_readers() {
    return names_in(folder / "readers.txt", "", ":");
}

std::vector<std::string> readers_that_are_not_there() {
    std::vector<std::string> missing;
    for (const auto& line : lines_of(folder / "readers.txt")) {
        std::istringstream words{line.starts_with('#') ? std::string{} : line};
        std::string word;
        words >> word; // the target
        while (words >> word) {
            if (!std::filesystem::exists(std::filesystem::path{testing::source_folder()} / word)) {
                missing.push_back(word);
            }
        }
    }
    return missing;
}

} // namespace macadam::fuzz
