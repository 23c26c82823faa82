#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace macadam {

struct TripMapping;

// What files are to trips, by their names.

/// *.trip.csv[.gz|.zst], *.rawlog.
bool is_trip_name(std::string_view name);

/// .zip, .tar, .tar.gz, .tgz, .tar.zst.
bool is_archive_name(std::string_view name);

/// A path's folder, "" or with a '/' at its end, and what follows.
std::pair<std::string, std::string> folder_and_file(const std::string& path);

/// The folder of the phone's export to which a file would belong, and what it is called in it;
/// the file's name is "" if it would belong to none.
std::pair<std::string, std::string> place_in_export(const std::string& path);

/// Exports of phones among paths: the folder of each, and its files as they are called in it, in
/// byte order.
std::map<std::string, std::vector<std::string>> exports_in(const std::vector<std::string>& paths);

/// What the file of one of a mapping's later tables is called that lies beside a file of its first.
std::string companion(const std::string& file, const TripMapping& mapping, std::size_t table);

} // namespace macadam
