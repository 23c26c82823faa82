#pragma once

#include "mapping/style/iri_class.hpp"

#include <memory>
#include <string>
#include <vector>

namespace macadam {

/// A user-defined class.
struct OwnClass {
    std::string name;
    double to_mm_per_m = 0; ///< infinity for the last class
    bool open = false;      ///< whether the bound itself belongs to the next class
};

/// A class table that is not among class_tables(), owning its strings. Copies share them.
class OwnClassTable {
public:
    /// \param classes  at least one, bounds ascending, the last infinity
    OwnClassTable(std::string name, std::string title, std::vector<OwnClass> classes);

    /// Returns the table, valid as long as any copy of this object.
    const ClassTable& table() const;

private:
    struct Kept;
    std::shared_ptr<const Kept> kept_;
};

} // namespace macadam
