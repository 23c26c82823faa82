#pragma once

#include "render/report/reference_page.hpp"
#include "storage/store/reader/store_reader.hpp"

#include <string>

namespace macadam {

/// Compares the cars of a database, on their own, with its references and control sections.
///
/// \param wording      for pages; JSON, CSV and the tables are in English and mm/m
/// \throws InputError  if the database has neither.
ReferenceReport
reference_report(const StoreReader& store, const std::string& title, const Localisation& wording);

} // namespace macadam
