#pragma once

#include <filesystem>

namespace macadam {

// GDAL opens files that other files name: sources, overviews, schemas, coordinate definitions. The
// guard sits between GDAL and the disk and blocks everything except the files allowed below.

/// Closes GDAL's virtual file systems: network, archives and streams entirely, the disk except for
/// the paths allowed below. Later calls have no effect.
void guard_files();

/// Lets GDAL read a file and its sidecar files with the same stem ("roads.dbf" of "roads.shp",
/// "map.tif.aux.xml" of "map.tif"), provided that they are regular files, do not leave the folder
/// through a link, and are neither databases nor virtual files.
void let_read(const std::filesystem::path& file);

/// Lets GDAL read all regular files of a folder that forms one data set.
void let_read_folder(const std::filesystem::path& folder);

/// Lets GDAL read and write in a folder of ours.
void let_write(const std::filesystem::path& folder);

} // namespace macadam
