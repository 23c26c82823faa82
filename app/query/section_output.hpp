#pragma once

#include "app/cli/row_writer.hpp"
#include "app/query/section_query.hpp"
#include "mapping/style/iri_class.hpp"

#include <string>
#include <string_view>

namespace macadam {

/// Section as a row of output.
struct ClassedSection {
    const NamedSection& named;
    const ClassTable& classes;
};

/// Returns a writer of sections.
/// \param format  table, json, csv or geojson
RowWriter<ClassedSection> section_writer(std::string_view format,
                                         RowWriter<ClassedSection>::Put put);

/// Describes a total: "3.42 km, 2.97 km of them measured".
std::string spoken(const SectionTotal& total);

} // namespace macadam
