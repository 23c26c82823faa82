#pragma once

#include "estimator/common/geo.hpp"
#include "storage/sqlite/sqlite.hpp"

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace macadam {

/// An R-tree of SQLite in two dimensions (x, then y) that is made from the bottom up, which takes a
/// tenth of the time of putting in row after row, and has full nodes.
///
/// Its nodes are written to the tables that SQLite keeps an R-tree in, as its "rtree" module would
/// (https://sqlite.org/rtree.html, 6). Boxes are tiled by place: S. T. Leutenegger, M. A. Lopez and
/// J. Edgington, "STR: a simple and efficient algorithm for R-tree packing", Proceedings of the
/// 13th International Conference on Data Engineering (1997), pp. 497-506.
class RtreeBulkLoad {
public:
    /// \param id  of a row; rising from one to the next.
    void add(std::int64_t id, const GeoBox& box);

    /// \param rtree  an empty one, of a database that is not in defensive mode; a name of ours, for
    ///               it stands in SQL as it is.
    void write_to(Database& database, std::string_view rtree) &&;

    struct Cell {
        std::array<float, 4> limits; ///< least x, most x, least y, most y
        std::uint32_t number;        ///< of the row added, or of the node below within its level
    };

private:
    std::vector<std::int64_t> ids_;
    std::vector<Cell> cells_;
};

} // namespace macadam
