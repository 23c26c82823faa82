#include "app/export/workbook_export.hpp"

#include "app/query/section_output.hpp"
#include "app/query/worst_sections_output.hpp"

#include "estimator/common/error.hpp"
#include "mapping/analysis/worst_sections.hpp"
#include "mapping/style/class_colours.hpp"
#include "storage/exports/export.hpp"
#include "storage/exports/xlsx_workbook.hpp"
#include "storage/networks/network_file.hpp"
#include "storage/text/column_meanings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace macadam {
namespace {

constexpr std::size_t report_every = 1000;

/// Columns of a sheet for the dictionary.
struct DescribedSheet {
    std::string name;
    std::vector<XlsxColumn> columns;
};

class WorkbookWriter {
public:
    WorkbookWriter(const StoreReader& store,
                   const WorkbookRequest& request,
                   const std::filesystem::path& file,
                   const Console& console)
        : store_{&store}, request_{&request}, console_{&console},
          classes_{class_table(store.settings().class_table)},
          book_{file,
                {.title = "Road roughness",
                 .comment = store.settings().attribution,
                 .created_s = store.seen().last_ms.value_or(0) / 1000}} {}

    std::size_t add_segments() {
        const auto columns = in_units(segment_columns(), request_->units);
        begin("segments", xlsx_columns(columns));
        const auto progress = console_->progress("writing");
        std::size_t count = 0;
        store_->visit(request_->filter, [&](const SegmentRecord& record) {
            book_.add_row(xlsx_row(columns, ClassedSegment{record, *classes_}),
                          record.state ? fill(record.state->iri_um / 1000.0) : std::nullopt);
            if (record.state) {
                measured_.push_back(record);
            }
            if (++count % report_every == 0) {
                progress(count, 0);
            }
            if (progress.stop.stop_requested()) {
                throw InputError{"stopped before the file was complete"};
            }
        });
        return count;
    }

    void add_sections(const SectionOptions& sections) {
        const auto columns = in_units(section_columns(), request_->units);
        begin("sections", xlsx_columns(columns));
        each_section(*store_, sections, request_->filter, [&](const NamedSection& section) {
            const auto& mean = section.section.measured.mean;
            book_.add_row(xlsx_row(columns, ClassedSection{section, *classes_}),
                          mean.length_m > 0 ? fill(mean.iri) : std::nullopt);
        });
    }

    void add_worst() {
        const auto columns = in_units(worst_section_columns(), request_->units);
        begin("worst", xlsx_columns(columns));
        WorstSectionConfig config;
        config.above_mm_per_m = poor_above(*classes_);
        std::size_t rank = 0;
        for (const auto& section :
             worst_sections(load_or_build_network(*store_), measured_, config)) {
            book_.add_row(xlsx_row(columns, RankedSection{++rank, section}));
        }
    }

    void add_dictionary() {
        const auto described = std::exchange(described_, {});
        begin(
            "columns",
            {{"sheet", as::text}, {"column", as::text}, {"unit", as::text}, {"meaning", as::text}});
        for (const auto& [sheet, columns] : described) {
            for (const auto& [name, type] : columns) {
                book_.add_row({sheet, name, type.unit, meaning_of_column(name)});
            }
        }
    }

    void commit() {
        store_->expect_in_place();
        book_.commit();
    }

private:
    void begin(const std::string& name, std::vector<XlsxColumn> columns) {
        const auto found = std::ranges::find(columns, "class", &XlsxColumn::name);
        class_column_ = static_cast<std::size_t>(found - columns.begin());
        described_.push_back({name, columns});
        book_.begin_sheet(name, std::move(columns));
    }

    std::optional<XlsxWorkbook::Fill> fill(double iri_mm_per_m) const {
        return XlsxWorkbook::Fill{
            class_column_,
            class_rgb(class_index(*classes_, iri_mm_per_m), classes_->classes.size())};
    }

    const StoreReader* store_;
    const WorkbookRequest* request_;
    const Console* console_;
    const ClassTable* classes_;
    XlsxWorkbook book_;
    std::vector<DescribedSheet> described_;
    std::vector<SegmentRecord> measured_;
    std::size_t class_column_ = 0;
};

} // namespace

void export_workbook(const StoreReader& store,
                     const WorkbookRequest& request,
                     const std::filesystem::path& file,
                     const Console& console) {
    WorkbookWriter workbook{store, request, file, console};
    const auto segments = workbook.add_segments();
    if (request.sections) {
        workbook.add_sections(*request.sections);
    }
    workbook.add_worst();
    workbook.add_dictionary();
    workbook.commit();
    console.say(fmt::format("{}: {}", file.string(), counted(segments, "segment")));
}

} // namespace macadam
