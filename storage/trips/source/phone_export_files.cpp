#include "storage/trips/source/phone_export_files.hpp"

#include "storage/tables/csv_cells.hpp"

namespace macadam {

bool marks_export(std::string_view file) {
    return is_named_in(file, total_files) || is_named_in(file, acc_files) ||
           is_named_in(file, linear_files) || is_named_in(file, raw_files) ||
           is_named_in(file, location_files);
}

bool belongs_to_export(std::string_view file) {
    return marks_export(file) || is_named_in(file, gyro_files) ||
           is_named_in(file, gravity_files) || fits(file, time_file) || fits(file, metadata_file);
}

} // namespace macadam
