#include "target_table.hpp"

#include <array>

namespace macadam::fuzz {
namespace {

// An input takes a reader of text some 5 ms with sanitizers, a store a tenth of a second.
constexpr std::array all{Target{"trip_log", trip_log, 400, 4},
                         Target{"trip_compressed", trip_compressed, 400, 4},
                         Target{"trip_archive", trip_archive, 400, 4},
                         Target{"trip_live", trip_live, 400, 4},
                         Target{"trip_trace", trip_trace, 40, 4},
                         Target{"trip_written", trip_written, 400, 4},
                         Target{"phone_export", phone_export, 400, 4},
                         Target{"log_detection", log_detection, 400, 4},
                         Target{"mapped_trip", mapped_trip, 400, 4},
                         Target{"rawlog", rawlog, 200, 4},
                         Target{"gpx", gpx, 400, 4},
                         Target{"nmea", nmea, 400, 4},
                         Target{"joined_trip", joined_trip, 80, 4},
                         Target{"can_log", can_log, 400, 4},
                         Target{"mdf", mdf, 400, 4},
                         Target{"hdf5", hdf5, 40, 4},
                         Target{"vehicle_toml", vehicle_toml, 400, 1},
                         Target{"recipe_toml", recipe_toml, 400, 4},
                         Target{"style_toml", style_toml, 400, 1},
                         Target{"appearance_toml", appearance_toml, 400, 1},
                         Target{"config_toml", config_toml, 400, 1},
                         Target{"profile_csv", profile_csv, 400, 4},
                         Target{"profile_txt", profile_txt, 400, 4},
                         Target{"profile_erd", profile_erd, 400, 4},
                         Target{"profile_pro", profile_pro, 400, 4},
                         Target{"truth_csv", truth_csv, 400, 1},
                         Target{"survey_csv", survey_csv, 400, 1},
                         Target{"reference_csv", reference_csv, 400, 1},
                         Target{"control_csv", control_csv, 400, 1},
                         Target{"section_file", section_file, 400, 4},
                         Target{"exclusion_file", exclusion_file, 400, 4},
                         Target{"osm_xml", osm_xml, 400, 4},
                         Target{"osm_pbf", osm_pbf, 400, 4},
                         Target{"line_layer", line_layer, 400, 4},
                         Target{"network_image", network_image, 400, 4},
                         Target{"base_map", base_map, 400, 4},
                         Target{"store_bytes", store_bytes, 80, 8},
                         Target{"store_content", store_content, 80, 8},
                         Target{"server_drive", server_drive, 400, 1},
                         Target{"server_line", server_line, 400, 1},
                         Target{"geometry_blob", geometry_blob, 400, 1},
                         Target{"segment_key", segment_key, 400, 1},
                         Target{"utc_time", utc_time, 400, 1},
                         Target{"command_line", command_line, 400, 1},
                         Target{"cql2_filter", cql2_filter, 400, 1},
                         Target{"http_request", http_request, 400, 1}};

} // namespace

std::span<const Target> targets() {
    return all;
}

} // namespace macadam::fuzz
