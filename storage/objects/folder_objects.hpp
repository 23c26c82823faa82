#pragma once

#include "storage/objects/object_store.hpp"

#include <filesystem>
#include <memory>

namespace macadam {

/// Opens a folder as an object store: object `abcd...` is the file `ab/cd/abcd...`. A missing
/// folder is made for its owner alone; who may enter an existing one may read its objects. An empty
/// subfolder `.macadam-objects` marks it, which an empty mount point lacks.
///
/// \throws InputError  if it cannot be made, is no folder, or is to be refused.
std::unique_ptr<ObjectStore> open_folder_objects(const std::filesystem::path& folder,
                                                 MissingFolder missing = MissingFolder::make);

} // namespace macadam
