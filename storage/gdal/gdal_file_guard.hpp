#pragma once

#include <filesystem>

namespace macadam {

// GDAL opens what a file names: sources, overviews, schemas, definitions of coordinates. The guard
// stands between GDAL and the disk, so that it opens what it was given and no other file.

/// Closes GDAL's file systems: those of the network, of archives and of streams for good, the disk
/// but for what is let through below. Once; later calls change nothing.
void guard_files();

/// Lets GDAL read a file, and those beside it that have its stem in common ("roads.dbf" of
/// "roads.shp", "map.tif.aux.xml" of "map.tif"), if they are regular files, do not lead out of the
/// folder by a link, and are neither databases nor virtual files.
void let_read(const std::filesystem::path& file);

/// Lets GDAL read all regular files of a folder, which is one data set.
void let_read_folder(const std::filesystem::path& folder);

/// Lets GDAL read and write in a folder of ours.
void let_write(const std::filesystem::path& folder);

} // namespace macadam
