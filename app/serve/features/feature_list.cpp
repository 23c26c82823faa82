#include "app/serve/features/feature_list.hpp"

#include "app/query/section_output.hpp"
#include "app/query/section_query.hpp"
#include "app/query/worst_sections_output.hpp"
#include "mapping/analysis/worst_sections.hpp"
#include "storage/exports/event_export.hpp"
#include "storage/networks/network_file.hpp"

#include <fmt/format.h>

#include <string>

namespace macadam {
namespace {

/// Sections with the rows that refer to them.
struct WorstRows {
    std::vector<WorstSection> sections;
    std::vector<RankedSection> ranked{};
};

struct SectionRows {
    std::vector<NamedSection> sections{};
    std::vector<ClassedSection> classed{};
};

/// Name of an event that stays while it is there: its segment, place and kind.
std::string id_of(const EventRecord& record) {
    const auto& columns = event_fields();
    std::string id = name_of(record.event.segment);
    for (const auto& column : columns) {
        if (column.name == "at_m" || column.name == "kind") {
            id += '-';
            id += plain_text(column.type, column.value(record)).value_or("");
        }
    }
    return id;
}

} // namespace

const std::vector<FeatureColumn>& worst_feature_columns() {
    static const auto columns = feature_columns(worst_section_columns());
    return columns;
}

FeatureList worst_features(const StoreReader& store) {
    const auto& classes = *class_table(store.settings().class_table);
    std::vector<SegmentRecord> records;
    store.visit({}, [&](const SegmentRecord& record) { records.push_back(record); });
    const auto rows = std::make_shared<WorstRows>(WorstRows{worst_sections(
        load_or_build_network(store), records, {.above_mm_per_m = poor_above(classes)})});
    FeatureList list{{}, rows};
    rows->ranked.reserve(rows->sections.size());
    for (const auto& section : rows->sections) {
        rows->ranked.push_back({rows->ranked.size() + 1, section});
        list.features.push_back({.id = fmt::format("{}", rows->ranked.size()),
                                 .line = section.line,
                                 .row = &rows->ranked.back()});
    }
    return list;
}

const std::vector<FeatureColumn>& event_feature_columns() {
    static const auto columns = feature_columns(event_fields());
    return columns;
}

FeatureList event_features(const StoreReader& store) {
    const auto rows = std::make_shared<const std::vector<EventRecord>>(store.events({}));
    FeatureList list{{}, rows};
    for (const auto& record : *rows) {
        list.features.push_back(
            {.id = id_of(record), .line = {&record.at, 1}, .is_point = true, .row = &record});
    }
    return list;
}

const std::vector<FeatureColumn>& section_feature_columns() {
    static const auto columns = feature_columns(section_columns());
    return columns;
}

FeatureList section_features(const StoreReader& store, const SectionOptions& sections) {
    const auto rows = std::make_shared<SectionRows>();
    each_section(store, sections, {}, [&](const NamedSection& section) {
        rows->sections.push_back(section);
    });
    const auto& classes = *class_table(store.settings().class_table);
    FeatureList list{{}, rows};
    rows->classed.reserve(rows->sections.size());
    for (const auto& named : rows->sections) {
        rows->classed.push_back({named, classes});
        list.features.push_back({.id = fmt::format("{}", rows->classed.size()),
                                 .line = named.section.line,
                                 .row = &rows->classed.back()});
    }
    return list;
}

} // namespace macadam
