#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace macadam {

struct TripMapping;

// Role of files in trips, by name.

/// Tests for *.trip.csv[.gz|.zst] and *.rawlog.
bool is_trip_name(std::string_view name);

/// Tests for names that logs of other programs may have: *.csv[.gz|.zst], *.txt and *.vbo, in upper
/// or lower case.
bool is_table_name(std::string_view name);

/// Tests for .zip, .tar, .tar.gz, .tgz, .tar.zst.
bool is_archive_name(std::string_view name);

/// Splits a path into its folder, "" or with a final '/', and the rest.
std::pair<std::string, std::string> folder_and_file(const std::string& path);

/// Splits a path into the folder of a phone export and the file name within it; the name is "" if
/// the file cannot belong to an export.
std::pair<std::string, std::string> place_in_export(const std::string& path);

/// Phone exports among paths: the folder of each, and the names of its files within it, in byte
/// order.
std::map<std::string, std::vector<std::string>> exports_in(const std::vector<std::string>& paths);

/// Name of the file of table `table` of a mapping that belongs to `file`, a file of the first
/// table.
std::string companion(const std::string& file, const TripMapping& mapping, std::size_t table);

} // namespace macadam
