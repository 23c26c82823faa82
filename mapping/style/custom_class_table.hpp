#pragma once

#include "mapping/style/iri_class.hpp"

#include <memory>
#include <string>
#include <vector>

namespace macadam {

/// A class as a user states it.
struct OwnClass {
    std::string name;
    double to_mm_per_m = 0; ///< infinity for the last
    bool open = false;      ///< the border itself belongs to the next class
};

/// A class table that is not among class_tables(), with the words that it consists of. Copies share
/// them.
class OwnClassTable {
public:
    /// \param classes  at least one, borders rising, the last infinity
    OwnClassTable(std::string name, std::string title, std::vector<OwnClass> classes);

    /// Valid as long as any copy of this.
    const ClassTable& table() const;

private:
    struct Kept;
    std::shared_ptr<const Kept> kept_;
};

} // namespace macadam
