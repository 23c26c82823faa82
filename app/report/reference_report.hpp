#pragma once

#include "render/report/reference_page.hpp"
#include "storage/store/road_store.hpp"

#include <string>

namespace macadam {

/// The cars of a store, alone, beside its references and control sections.
///
/// \param wording      of pages; JSON, CSV and the tables are in English and mm/m
/// \throws InputError  if it holds neither.
ReferenceReport
reference_report(const RoadStore& store, const std::string& title, const Localisation& wording);

} // namespace macadam
