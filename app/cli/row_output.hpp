#pragma once

#include "app/cli/arguments.hpp"

#include "storage/atomic/atomic_file.hpp"

#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

namespace macadam {

/// Name of standard output after -o.
inline constexpr std::string_view standard_output = "-";

/// \name Options of commands that print rows
/// @{
inline constexpr Option row_output_option{
    "-o,--output", "FILE", "Write to this file instead of standard output."};
inline constexpr Option json_option{"--json", "", "The same as --format json."};
/// @}

/// Returns the format of rows: --format; json with --json; else the choice of --format that the
/// suffix of -o names; else the first choice.
/// \throws UsageError  if --json contradicts --format.
std::string row_format_of(const Arguments& arguments);

/// Returns the file of -o of a command whose first format is a table; `std::nullopt` for "-".
/// \param others  suffixes of files of another kind that -o names, such as ".html"
/// \throws UsageError  if only its suffix can tell the format, and it names none; .txt is a table.
std::optional<std::filesystem::path>
row_file_of(const Arguments& arguments, std::initializer_list<std::string_view> others = {});

/// Directs print() to a file while this object exists. The file appears complete with commit(), or
/// not at all. Without a file, print() goes to standard output as ever. One object at a time.
class RowOutput {
public:
    explicit RowOutput(const std::optional<std::filesystem::path>& file);
    RowOutput(const RowOutput&) = delete;
    RowOutput& operator=(const RowOutput&) = delete;
    ~RowOutput();

    void commit();

    /// Writes to the file of the object that exists; false if there is none.
    static bool write(std::string_view text);

private:
    std::optional<AtomicFile> file_;
};

} // namespace macadam
