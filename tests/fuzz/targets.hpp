#pragma once

#include <string_view>

/// Readers fed with bytes that no one vouches for. A target reads its input as one of the program's
/// readers would, and then asks of what came out what must hold whatever went in. A refusal in
/// words is a good end; any other exception, a sanitizer's alarm, 25 s or 2 GB is a finding.
///
/// libFuzzer calls a target through entry.cpp, the ordinary tests through target_table.hpp.
/// readers.txt says which source files each of them is to cover.
namespace macadam::fuzz {

/// Says whether the reader took all of an input; every seed is accepted.
enum class Answer { accepted, refused };

Answer trip_log(std::string_view input);        ///< the text of a trip log
Answer trip_compressed(std::string_view input); ///< a trip log in gzip or Zstandard
Answer trip_archive(std::string_view input);    ///< a .zip or .tar of trips, of any kind
Answer trip_live(std::string_view input);       ///< a trip log as `trace --live` reads it
Answer trip_trace(std::string_view input);      ///< the text of a trip log, through the estimator
Answer trip_written(std::string_view input);    ///< the text of a trip log, read, written, read
Answer phone_export(std::string_view input);    ///< the files of phyphox or Sensor Logger
Answer log_detection(std::string_view input);   ///< a CSV file of another program
Answer mapped_trip(std::string_view input);     ///< a mapping, and a table for it
Answer rawlog(std::string_view input);          ///< of MRPT, by its own reader
Answer gpx(std::string_view input);             ///< a track, and the roads that it draws
Answer nmea(std::string_view input);            ///< the recording of a receiver
Answer joined_trip(std::string_view input);     ///< a log, and its positions in GPX or NMEA
Answer can_log(std::string_view input);         ///< a mapping, its DBC file and a log
Answer mdf(std::string_view input);             ///< a mapping, and an ASAM MDF file
Answer hdf5(std::string_view input);            ///< a mapping, and an HDF5 file
Answer vehicle_toml(std::string_view input);
Answer recipe_toml(std::string_view input);     ///< of a simulated fleet
Answer style_toml(std::string_view input);      ///< of a map
Answer appearance_toml(std::string_view input); ///< beside a database
Answer config_toml(std::string_view input);     ///< a user's defaults of options
Answer profile_csv(std::string_view input);
Answer profile_txt(std::string_view input);
Answer profile_erd(std::string_view input); ///< the header, and perhaps its numbers in a .bin
Answer profile_pro(std::string_view input);
Answer truth_csv(std::string_view input);
Answer survey_csv(std::string_view input);    ///< and a trip along it
Answer reference_csv(std::string_view input); ///< a survey that is to enter a database
Answer control_csv(std::string_view input);
Answer section_file(std::string_view input);   ///< a table, a GPX track or GeoJSON
Answer exclusion_file(std::string_view input); ///< the same
Answer osm_xml(std::string_view input);        ///< also in gzip or bzip2
Answer osm_pbf(std::string_view input);
Answer line_layer(std::string_view input); ///< GeoJSON, by GDAL

/// A raster to lie under the roads, by GDAL: a GeoTIFF, MBTiles, a virtual raster, or a.png with
/// a.pgw and a.prj, or with b.tif where it is a virtual one, as parts of one input.
Answer base_map(std::string_view input);

/// The file beside a store, with the sums that its bytes have; what is opened is used.
Answer network_image(std::string_view input);

/// Overwrites bytes of a good store and reads it. The input is a list of patches: where (4 bytes,
/// little endian, modulo the size of the file), how many (1 byte), the new bytes.
Answer store_bytes(std::string_view input);

/// Runs SQL on a good store, as somebody who wishes its readers ill would, and reads it.
Answer store_content(std::string_view input);

/// Values of a database on a server: packed passes of a drive, a line as PostGIS sends it.
Answer server_drive(std::string_view input);
Answer server_line(std::string_view input);

Answer geometry_blob(std::string_view input);
Answer segment_key(std::string_view input);
Answer utc_time(std::string_view input);
Answer command_line(std::string_view input); ///< a command's name and its words, one a line
Answer cql2_filter(std::string_view input);  ///< a filter in CQL2 text or JSON, applied
Answer http_request(std::string_view input); ///< a target, and headers, one a line

} // namespace macadam::fuzz
