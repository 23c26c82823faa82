#pragma once

#include "estimator/common/progress.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/store/publication/publication_rows.hpp"
#include "storage/store/publication/publication_work.hpp"
#include "storage/store/records/publication.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace macadam {

/// Next publication, computed into temporary tables of the connection while others write, and
/// applied in a short write transaction. The tables are private and deleted with the instance. At
/// most one instance per connection, created outside of transactions.
class StagedPublication {
public:
    explicit StagedPublication(Database& database);
    StagedPublication(const StagedPublication&) = delete;
    StagedPublication& operator=(const StagedPublication&) = delete;
    ~StagedPublication();

    /// Computes the publication from the database as the caller's transaction sees it. Replaces
    /// what was staged before.
    ///
    /// \throws InputError  if a stop is requested.
    void compute(const PublicationWork& work, const Progress& progress);

    /// Writes the staged values into the tables, withdraws segments whose road was rebuilt after
    /// their published passes, and adds the row of the publication. Within the caller's write
    /// transaction; trips added since compute() are left to the next publication.
    Published apply(const std::string& month);

private:
    void leave_other_chunks(const std::vector<std::int64_t>& chunks);
    void write_values();
    Publication add_publication(const std::string& month);

    Database* database_;
    std::size_t changed_ = 0; ///< segments with new values
    PublicationReach reach_;
    PublishedPart whole_; ///< totals of the database, and of chunks that it does not hold
};

} // namespace macadam
