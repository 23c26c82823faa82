#pragma once

#include "estimator/common/progress.hpp"
#include "mapping/alignment/alignment.hpp"
#include "storage/store/privacy/privacy_key.hpp"
#include "storage/store/records/fusion_record.hpp"
#include "storage/store/records/store_records.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace macadam {

/// State of the journal of a database when an import begins.
struct BegunImport {
    std::optional<OpenImport> earlier; ///< one of this name that started and did not finish
    bool same_runs = false;            ///< another import of this name is running
    bool other_runs = false;           ///< another import is running
};

/// Chunks that somebody else fuses just now, or holds without going on: a fusion waits until they
/// are fused, by whomever, or leaves them to the next one.
enum class BusyChunks : std::uint8_t { await, leave };

/// Database that takes trips in, on any engine. Each call is one transaction, durable on return;
/// only refresh() takes several. Not for several threads at once.
///
/// \throws InputError  from every call, with the name of the database and the cause.
class ImportTarget {
public:
    ImportTarget() = default;
    ImportTarget(const ImportTarget&) = delete;
    ImportTarget& operator=(const ImportTarget&) = delete;
    virtual ~ImportTarget() = default;

    virtual bool contains_trip(const std::string& sha256) = 0;

    /// Tests whether a trip in the database was imported as one of this car.
    virtual bool is_trip_of(const std::string& sha256, const std::string& vehicle_id) = 0;

    /// Settings with which a trip of a car was imported; `std::nullopt` if there is no such trip.
    virtual std::optional<TripSettings> settings_of_trip(const std::string& sha256) = 0;

    /// Tests whether the trip was forgotten; add_trips() skips such trips.
    virtual bool has_forgotten(const std::string& sha256) = 0;

    /// Creates a new key if there is none, where the engine may do so.
    /// \returns true if cars were named under a lost key: cars imported from now on cannot be
    /// linked to them.
    virtual bool make_missing_key() = 0;

    /// Key of the database; null before make_missing_key() if there is none.
    virtual const PrivacyKey* key() const = 0;
    virtual std::filesystem::path key_file() const = 0;

    /// Adds trips: all of them or, on failure, none. A trip that is already stored or was forgotten
    /// is skipped. \returns for each trip whether it is new.
    ///
    /// \throws InputError  if the network of the database was replaced since it was opened.
    virtual std::vector<bool> add_trips(std::span<const NewTrip> trips) = 0;

    /// Records the start of an import in a journal, and shows it as running until end_import(), the
    /// end of this object or that of the process.
    ///
    /// \param name  identifies the request, so that a repeated request finds its journal entry.
    virtual BegunImport begin_import(const std::string& name, std::size_t trips_asked) = 0;

    /// Removes the journal entry of a finished import.
    virtual void end_import(const std::string& name) = 0;

    /// Aligns and fuses the passes of every chunk that has newer passes than its states, by the
    /// rules of the current generation.
    ///
    /// \param record  of the earlier fusions of the same import; this one is added
    /// \returns the number of segments fused.
    virtual std::size_t
    refresh(const Progress& progress, FusionRecord& record, BusyChunks busy) = 0;

    /// Number of segments whose new passes are not fused yet.
    virtual std::size_t waiting() = 0;

    /// Summary of the alignment of all fused chunks.
    virtual AlignmentSummary alignment() = 0;
};

} // namespace macadam
