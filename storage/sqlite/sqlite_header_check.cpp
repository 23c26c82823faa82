#include "storage/sqlite/sqlite_header_check.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
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

struct Close {
    void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
};

/// Returns the first bytes of a file. They are read with SQLite: where it has the file open in this
/// process, any other descriptor would drop its locks as it is closed.
///
/// Source: How To Corrupt An SQLite Database File, 2.2.1.
/// \throws InputError  if the file cannot be opened or read.
std::string head_of(const std::filesystem::path& file) {
    constexpr sqlite3_int64 enough = 256;
    sqlite3* opened = nullptr;
    const auto name = std::filesystem::absolute(file).string(); // never ":memory:"
    const int code =
        sqlite3_open_v2(name.c_str(), &opened, SQLITE_OPEN_READONLY | SQLITE_OPEN_NOMUTEX, nullptr);
    const std::unique_ptr<sqlite3, Close> database{opened};
    sqlite3_file* bytes = nullptr;
    if (code != SQLITE_OK ||
        sqlite3_file_control(
            opened, "main", SQLITE_FCNTL_FILE_POINTER, static_cast<void*>(&bytes)) != SQLITE_OK ||
        bytes->pMethods == nullptr) {
        throw InputError{fmt::format("{}: cannot be opened: {}",
                                     file.string(),
                                     sqlite3_errstr(code != SQLITE_OK ? code : SQLITE_CANTOPEN))};
    }
    const auto expect_done = [&](int done) {
        if (done != SQLITE_OK) {
            throw InputError{
                fmt::format("{}: cannot be read: {}", file.string(), sqlite3_errstr(done))};
        }
    };
    sqlite3_int64 size = 0;
    expect_done(bytes->pMethods->xFileSize(bytes, &size));
    std::string head(static_cast<std::size_t>(std::min(size, enough)), '\0');
    expect_done(bytes->pMethods->xRead(bytes, head.data(), static_cast<int>(head.size()), 0));
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
                        head.empty() ? "empty" : kind_of(head))};
    }
}

} // namespace macadam
