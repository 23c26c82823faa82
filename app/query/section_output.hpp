#pragma once

#include "app/cli/row_writer.hpp"
#include "app/query/section_query.hpp"
#include "mapping/style/iri_class.hpp"
#include "storage/text/unit_system.hpp"

#include <memory>
#include <string>
#include <string_view>

namespace macadam {

/// Section as a row of output.
struct ClassedSection {
    const NamedSection& named;
    const ClassTable& classes;
};

/// Columns of sections for every format, in the order of docs/reference/sections.md.
const Columns<ClassedSection>& section_columns();

/// Writer of sections with its columns.
struct SectionWriter {
    std::shared_ptr<const Columns<ClassedSection>> columns;
    RowWriter<ClassedSection> rows;
};

/// Returns a writer of sections.
/// \param format  table, json, csv or geojson
SectionWriter section_writer(std::string_view format,
                             RowWriter<ClassedSection>::Put put,
                             UnitSystem units = UnitSystem::si);

/// Describes a total: "3.42 km, of which 2.97 km measured".
std::string spoken(const SectionTotal& total, UnitSystem units = UnitSystem::si);

} // namespace macadam
