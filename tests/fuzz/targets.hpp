#pragma once

#include <string_view>

/// Readers fed with bytes that no one vouches for. A target reads its input as one of the program's
/// readers would, and then asks of what came out what must hold whatever went in. A refusal in
/// words is a good end; any other exception, a sanitizer's alarm, 25 s or 2 GB is a finding.
///
/// libFuzzer calls a target through entry.cpp, the ordinary tests through replay_test.cpp.
namespace macadam::fuzz {

void trip_log(std::string_view input);        ///< the text of a trip log
void trip_compressed(std::string_view input); ///< a trip log in gzip or Zstandard
void trip_archive(std::string_view input);    ///< a .zip or .tar of trip logs
void trip_trace(std::string_view input);      ///< the text of a trip log, through the estimator
void trip_written(std::string_view input);    ///< the text of a trip log, read, written, read
void phone_export(std::string_view input);    ///< the files of phyphox or Sensor Logger
void mapped_trip(std::string_view input);     ///< a mapping, and a table for it
void rawlog(std::string_view input);          ///< of MRPT, by its own reader
void gpx(std::string_view input);             ///< a track, and the roads that it draws
void vehicle_toml(std::string_view input);
void recipe_toml(std::string_view input); ///< of a simulated fleet
void profile_csv(std::string_view input);
void profile_txt(std::string_view input);
void profile_erd(std::string_view input); ///< the header, and perhaps its numbers in a .bin
void profile_pro(std::string_view input);
void truth_csv(std::string_view input);
void survey_csv(std::string_view input); ///< and a trip along it
void osm_xml(std::string_view input);
void osm_pbf(std::string_view input);
void line_layer(std::string_view input); ///< GeoJSON, by GDAL

/// The file beside a store, with the sums that its bytes have; what is opened is used.
void network_image(std::string_view input);

/// Overwrites bytes of a good store and reads it. The input is a list of patches: where (4 bytes,
/// little endian, modulo the size of the file), how many (1 byte), the new bytes.
void store_bytes(std::string_view input);

/// Runs SQL on a good store, as somebody who wishes its readers ill would, and reads it.
void store_content(std::string_view input);

void geometry_blob(std::string_view input);
void segment_key(std::string_view input);
void utc_time(std::string_view input);
void command_line(std::string_view input); ///< a command's name and its words, one a line

} // namespace macadam::fuzz
