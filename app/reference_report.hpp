#pragma once

#include "render/report/reference_page.hpp"
#include "storage/road_store.hpp"

#include <string>

namespace macadam {

/// The cars of a store, alone, beside its references and control sections.
///
/// \param wording      of pages; JSON, CSV and the tables are in English and mm/m
/// \throws InputError  if it holds neither.
ReferenceReport
reference_report(const RoadStore& store, const std::string& title, const Wording& wording);

/// All scores, as one JSON object.
std::string reference_json(const ReferenceReport& report);

/// A row for each piece that was compared: first segments, then pieces of 100 m.
std::string reference_csv(const ReferenceReport& report);

/// Tables for people.
std::string reference_text(const ReferenceReport& report);

} // namespace macadam
