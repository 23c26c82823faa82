#include "storage/trips/source/phone_export_files.hpp"

#include "storage/tables/csv_cells.hpp"

namespace macadam {

bool marks_export(std::string_view file) {
    return is_one_of(file, total_files) || is_one_of(file, acc_files) ||
           is_one_of(file, linear_files) || is_one_of(file, raw_files) ||
           is_one_of(file, location_files);
}

bool belongs_to_export(std::string_view file) {
    return marks_export(file) || is_one_of(file, gyro_files) || is_one_of(file, gravity_files) ||
           fits(file, time_file) || fits(file, metadata_file);
}

} // namespace macadam
