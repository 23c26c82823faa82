#include "app/cli/row_output.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace macadam {
namespace {

/// File to which print() writes, as standard output is one for the whole program; null: there.
AtomicFile* current_file = nullptr; // NOLINT(*-avoid-non-const-global-variables)

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
    const auto suffix =
        std::filesystem::path{arguments.value("--output").value_or("")}.extension().string();
    const auto choices = arguments.choices("--format");
    const auto named = suffix.empty()
                           ? choices.end()
                           : std::ranges::find(choices, std::string_view{suffix}.substr(1));
    return std::string{named == choices.end() ? choices.front() : *named};
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
