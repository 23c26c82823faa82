#include "storage/trips/source/phone_export_files.hpp"

#include "storage/tables/csv_cells.hpp"

#include <algorithm>
#include <iterator>

namespace macadam {

namespace {

template <std::size_t count>
bool is_one_of(std::string_view file, const std::string_view (&names)[count]) {
    return std::any_of(std::begin(names), std::end(names), [&](std::string_view name) {
        return fits(file, name);
    });
}

} // namespace

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
