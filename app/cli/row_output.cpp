#include "app/cli/row_output.hpp"

#include "estimator/common/ascii.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace macadam {
namespace {

/// File to which print() writes, as standard output is one for the whole program; null: there.
AtomicFile* current_file = nullptr; // NOLINT(*-avoid-non-const-global-variables)

/// Returns "csv" of "roads.CSV"; "" of a name without suffix.
std::string suffix_of(const std::filesystem::path& file) {
    return file.has_extension() ? in_lower_case(file.extension().string().substr(1)) : "";
}

} // namespace

std::string row_format_of(const Arguments& arguments) {
    const auto format = arguments.value("--format");
    if (arguments.flag("--json")) {
        if (format && *format != "json") {
            throw UsageError{fmt::format("--json and --format {} cannot be combined", *format)};
        }
        return "json";
    }
    if (format) {
        return *format;
    }
    const auto& choices = arguments.choices("--format");
    for (const auto& file : arguments.values("--output")) {
        const auto named = std::ranges::find(choices, suffix_of(file));
        if (named != choices.end()) {
            return std::string{*named};
        }
    }
    return std::string{choices.front()};
}

std::optional<std::filesystem::path> row_file_of(const Arguments& arguments,
                                                 std::initializer_list<std::string_view> others) {
    const bool is_format_given = arguments.value("--format") || arguments.flag("--json");
    auto choices = arguments.choices("--format");
    std::erase_if(choices, [&](std::string_view choice) {
        return std::ranges::find(others, "." + std::string{choice}) != others.end();
    });
    std::optional<std::filesystem::path> row_file;
    for (const auto& file : arguments.values("--output")) {
        const auto suffix = suffix_of(file);
        if (file == standard_output) {
            continue;
        }
        if (std::ranges::find(others, std::filesystem::path{file}.extension().string()) !=
            others.end()) {
            continue;
        }
        const bool names_format = suffix.empty() || suffix == "txt" ||
                                  std::ranges::find(choices, suffix) != choices.end();
        if (!is_format_given && !names_format) {
            throw UsageError{fmt::format("-o is '{}', expected a name that ends in {}{}.{}, or "
                                         "--format",
                                         file,
                                         fmt::join(others, ", "),
                                         others.size() > 0 ? ", " : "",
                                         fmt::join(choices.begin() + 1, choices.end(), ", ."))};
        }
        if (row_file) {
            throw UsageError{
                fmt::format("-o names two files of rows, '{}' and '{}'", row_file->string(), file)};
        }
        row_file = file;
    }
    return row_file;
}

RowOutput::RowOutput(const std::optional<std::filesystem::path>& file) {
    if (file && *file != standard_output) {
        current_file = &file_.emplace(*file);
    }
}

RowOutput::~RowOutput() {
    current_file = nullptr;
}

void RowOutput::commit() {
    current_file = nullptr;
    if (file_) {
        file_->commit();
    }
}

bool RowOutput::write(std::string_view text) {
    if (current_file != nullptr) {
        current_file->write(text);
    }
    return current_file != nullptr;
}

} // namespace macadam
