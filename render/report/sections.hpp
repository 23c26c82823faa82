#pragma once

#include "render/report/document/document.hpp"
#include "render/report/report.hpp"

#include <string>

namespace macadam {

// Parts of the report. Condition and worst sections require measurements.
document::RichText subtitle_of(const Report& report);
document::RichText lead_of(const Report& report); ///< empty: nothing measured
document::Overview overview_of(const Report& report);
document::KeyNumbers key_numbers(const Report& report);
document::DocumentSection condition_section(const Report& report);
document::DocumentSection worst_section(const Report& report);
document::DocumentSection events_section(const Report& report); ///< requires events
document::DocumentSection change_section(const Report& report); ///< requires report.change
document::DocumentSection strip_section(const Report& report);  ///< requires strips
document::DocumentSection own_sections(const Report& report);   ///< requires sections
document::DocumentSection coverage_section(const Report& report);
document::DocumentSection data_section(const Report& report);
document::DocumentSection reading_section(const Report& report);
document::DocumentSection method_section(const Report& report);
document::DocumentSection limits_section(const Report& report);
document::DocumentSection source_section(const Report& report); ///< data sources

} // namespace macadam
