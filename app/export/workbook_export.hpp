#pragma once

#include "app/cli/console.hpp"
#include "app/query/section_options.hpp"
#include "storage/store/reader/store_reader.hpp"
#include "storage/text/unit_system.hpp"

#include <filesystem>
#include <optional>

namespace macadam {

/// Content of a workbook.
struct WorkbookRequest {
    SegmentFilter filter;
    std::optional<SectionOptions> sections; ///< for a sheet of their own
    UnitSystem units = UnitSystem::si;
};

/// Writes the segments of a filter to an .xlsx file, with the worst sections among them, the user's
/// own sections, and a sheet that explains every column. The file appears complete or not at all.
///
/// \throws InputError  for more segments than a sheet has rows, if the file cannot be written, and
///                     on a stop request.
void export_workbook(const StoreReader& store,
                     const WorkbookRequest& request,
                     const std::filesystem::path& file,
                     const Console& console);

} // namespace macadam
