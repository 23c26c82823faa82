#include "app/query/audit_output.hpp"

#include "storage/exports/export.hpp"
#include "storage/text/json.hpp"

#include <fmt/format.h>

namespace macadam {
namespace {

/// Removes the fraction of a time such as "2026-03-01T06:00:00.000Z".
std::string second_of(const std::string& at) {
    return at.size() > 20 ? at.substr(0, 19) + "Z" : at;
}

std::string iri_words(const NumberChange& change) {
    return change.iri_um ? fmt::format("{:>7.3f} {:>7.3f}",
                                       *change.iri_um / 1000.0,
                                       change.sd_um.value_or(0) / 1000.0)
                         : fmt::format("{:>7} {:>7}", "-", "-");
}

std::string changes_table(const std::vector<NumberChange>& changes) {
    if (changes.empty()) {
        return "no recorded change of this segment's value\n";
    }
    auto text = fmt::format(
        "{:<21} {:>3} {:>7} {:>7} {:>6}  {}\n", "when", "gen", "IRI", "sd", "passes", "why");
    for (const auto& change : changes) {
        text += fmt::format("{:<21} {:>3} {} {:>6}  {}: {}\n",
                            second_of(change.cause.at),
                            change.cause.generation,
                            iri_words(change),
                            change.passes,
                            change.cause.what,
                            change.cause.detail);
    }
    return text;
}

std::string changes_csv(const std::vector<NumberChange>& changes) {
    std::string text = "at,generation,iri,iri_sd,passes,what,detail\n";
    for (const auto& change : changes) {
        const bool known = change.iri_um.has_value();
        text += fmt::format("{},{},{},{},{},{},{}\n",
                            change.cause.at,
                            change.cause.generation,
                            known ? fmt::format("{:.3f}", *change.iri_um / 1000.0) : "",
                            known ? fmt::format("{:.3f}", change.sd_um.value_or(0) / 1000.0) : "",
                            change.passes,
                            csv_text(change.cause.what),
                            csv_text(change.cause.detail));
    }
    return text;
}

void add_cause(JsonObject& object, const AuditEntry& cause) {
    object.add("at", cause.at)
        .add("generation", std::int64_t{cause.generation})
        .add("what", cause.what)
        .add("detail", cause.detail);
}

std::string changes_json(const std::vector<NumberChange>& changes) {
    std::vector<std::string> entries;
    for (const auto& change : changes) {
        JsonObject entry;
        add_cause(entry, change.cause);
        if (change.iri_um) {
            entry.add("iri", JsonNumber{*change.iri_um / 1000.0, 3})
                .add("iri_sd", JsonNumber{change.sd_um.value_or(0) / 1000.0, 3});
        } else {
            entry.add("iri", nullptr).add("iri_sd", nullptr);
        }
        entry.add("passes", change.passes);
        entries.push_back(entry.text());
    }
    return json_array(entries) + "\n";
}

} // namespace

std::string text_of(const std::vector<AuditEntry>& entries) {
    if (entries.empty()) {
        return "no recorded change of any value\n";
    }
    auto text = fmt::format("{:<21} {:>3} {:>9}  {}\n", "when", "gen", "segments", "operation");
    for (const auto& entry : entries) {
        text += fmt::format("{:<21} {:>3} {:>9}  {}: {}\n",
                            second_of(entry.at),
                            entry.generation,
                            entry.segments,
                            entry.what,
                            entry.detail);
    }
    return text;
}

std::string json_of(const std::vector<AuditEntry>& entries) {
    std::vector<std::string> lines;
    for (const auto& entry : entries) {
        JsonObject object;
        add_cause(object, entry);
        object.add("segments", static_cast<std::int64_t>(entry.segments));
        lines.push_back(object.text());
    }
    return json_array(lines) + "\n";
}

std::string changes_text(const std::vector<NumberChange>& changes, std::string_view format) {
    return format == "json"  ? changes_json(changes)
           : format == "csv" ? changes_csv(changes)
                             : changes_table(changes);
}

} // namespace macadam
