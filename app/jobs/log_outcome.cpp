#include "app/jobs/log_outcome.hpp"

#include <algorithm>

namespace macadam {
namespace {

std::string without_path(std::string text, const std::filesystem::path& file) {
    const auto path = file.string();
    const auto stem = file.filename().string();
    const auto name = "log" + stem.substr(std::min(stem.find('.'), stem.size()));
    for (auto at = text.find(path); at != std::string::npos; at = text.find(path, at)) {
        text.replace(at, path.size(), name);
        at += name.size();
    }
    return text;
}

void add_reason(LogOutcome& outcome, const std::string& reason) {
    if (outcome.reason.empty()) {
        outcome.reason = reason;
    }
}

} // namespace

bool is_of(const TripReport& report, const std::filesystem::path& file) {
    const auto& name = file.native();
    return report.file.starts_with(name) &&
           (report.file.size() == name.size() || report.file[name.size()] == '/');
}

void add(LogOutcome& outcome,
         const TripReport& report,
         const std::filesystem::path& file,
         bool is_our_own) {
    using Result = TripReport::Result;
    if (report.result == Result::imported || report.result == Result::known) {
        outcome.stored.push_back(report.sha256);
    }
    if (report.result == Result::imported || (report.result == Result::known && is_our_own)) {
        ++outcome.imported;
        outcome.own.push_back(report.sha256);
        outcome.passes += static_cast<std::int64_t>(report.passes);
    } else if (report.result == Result::known) {
        ++outcome.known;
        const auto why = std::ranges::find_if(report.warnings, [](const std::string& warning) {
            return warning.starts_with("was "); // permanently deleted; others are notes on values
        });
        add_reason(outcome, why == report.warnings.end() ? "already imported" : *why);
    } else if (report.result == Result::outside) {
        ++outcome.outside;
        add_reason(outcome, "touches no road of this map, not stored");
    } else {
        ++outcome.rejected;
        add_reason(outcome, without_path(report.error, file));
    }
}

LogFate fate_of(const LogOutcome& outcome) {
    const auto state = outcome.imported > 0   ? UploadState::imported
                       : outcome.known > 0    ? UploadState::known
                       : outcome.rejected > 0 ? UploadState::refused
                       : outcome.outside > 0  ? UploadState::outside
                                              : UploadState::refused;
    const bool is_partial = outcome.imported > 0 && outcome.rejected > 0;
    LogFate fate{state, outcome.trips() == 0 ? "no trip log was found" : outcome.reason};
    if (state == UploadState::imported && !is_partial) {
        fate.reason.clear();
    }
    return fate;
}

} // namespace macadam
