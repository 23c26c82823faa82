#include "storage/sqlite/sqlite_header_check.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <string>
#include <string_view>

namespace macadam {
namespace {

using namespace std::string_view_literals;

struct Kind {
    std::string_view begins_with;
    std::string_view name;
};

constexpr std::string_view sqlite_head = "SQLite format 3\0"sv; // SQLite's file format, 1.3.1

/// Formats that are likely to lie beside databases and trips.
constexpr std::array kinds{Kind{"\x89PNG", "a PNG picture"},
                           Kind{"\xff\xd8\xff", "a JPEG picture"},
                           Kind{"%PDF", "a PDF"},
                           Kind{"PK\3\4", "a zip archive"},
                           Kind{"\x1f\x8b", "a gzip-compressed file"},
                           Kind{"\x28\xb5\x2f\xfd", "a Zstandard-compressed file"},
                           Kind{"fgb\3", "a FlatGeobuf file"}};

std::string head_of(const std::filesystem::path& file) {
    constexpr std::size_t enough = 256;
    std::string head(enough, '\0');
    std::ifstream in{file, std::ios::binary};
    in.read(head.data(), static_cast<std::streamsize>(head.size()));
    head.resize(static_cast<std::size_t>(in.gcount()));
    return head;
}

bool is_text(std::string_view head) {
    return std::ranges::none_of(head, [](char c) {
        const auto byte = static_cast<unsigned char>(c);
        return (byte < 0x20 && c != '\n' && c != '\r' && c != '\t') || byte == 0x7f;
    });
}

std::string kind_of(std::string_view head) {
    for (const auto& [begins_with, name] : kinds) {
        if (head.starts_with(begins_with)) {
            return std::string{name};
        }
    }
    if (is_text(head)) {
        return "a text file";
    }
    std::string bytes;
    for (const char c : head.substr(0, 8)) {
        bytes += fmt::format(" {:02x}", static_cast<unsigned char>(c));
    }
    return fmt::format("a binary file that begins with{}", bytes);
}

} // namespace

void expect_store_file(const std::filesystem::path& file) {
    const auto refuse = [&](std::string_view what, std::string_view is) {
        throw InputError{fmt::format(
            "{}: {}, expected a database made by 'macadam init'{}", file.string(), what, is)};
    };
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) {
        refuse("no such file", "");
    }
    if (!std::filesystem::is_regular_file(file, ignored)) {
        refuse("is not a file",
               std::filesystem::is_directory(file, ignored) ? "; it is a folder" : "");
    }
    const auto head = head_of(file);
    if (!head.starts_with(sqlite_head)) {
        throw InputError{
            fmt::format("{}: is {}, not a Macadam database; expected one made by 'macadam init'",
                        file.string(),
                        head.empty() ? "empty or unreadable" : kind_of(head))};
    }
}

} // namespace macadam
