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
    const auto suffix = suffix_of(arguments.value("--output").value_or(""));
    const auto choices = arguments.choices("--format");
    const auto named = std::ranges::find(choices, suffix);
    return std::string{named == choices.end() ? choices.front() : *named};
}

std::optional<std::filesystem::path> row_file_of(const Arguments& arguments) {
    const auto file = arguments.value("--output");
    if (!file || arguments.value("--format") || arguments.flag("--json")) {
        return file;
    }
    const auto suffix = suffix_of(*file);
    const auto choices = arguments.choices("--format");
    if (!suffix.empty() && suffix != "txt" && std::ranges::find(choices, suffix) == choices.end()) {
        throw UsageError{fmt::format("-o is '{}', expected a name that ends in .{}, or --format",
                                     *file,
                                     fmt::join(choices.begin() + 1, choices.end(), ", ."))};
    }
    return file;
}

RowOutput::RowOutput(const std::optional<std::filesystem::path>& file) {
    if (file) {
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
