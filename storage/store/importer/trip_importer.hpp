#pragma once

#include "estimator/common/progress.hpp"
#include "storage/store/records/fusion_record.hpp"
#include "storage/store/records/store_records.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace macadam {

struct StoreConnection;

/// Imports trips into a road database and fuses their passes. Each call is one atomic transaction,
/// durable on return; only refresh() takes several, so that other writers get their turn, and
/// resumes after an interruption.
///
/// \throws InputError  from every call, if the file was removed, is locked by an idle program, or
///                     is not writable (the message names the file and the cause).
class TripImporter {
public:
    explicit TripImporter(std::shared_ptr<StoreConnection> store) : store_{std::move(store)} {}

    /// Creates a new key if there is none; add_trips() does so when it has to name a car.
    /// \returns true if cars of the database were named under a lost key: cars imported from now on
    /// cannot be linked to them.
    bool make_missing_key();

    /// Adds trips: all of them or, on failure, none. A trip that is already stored or was forgotten
    /// is skipped. \returns for each trip whether it is new.
    ///
    /// \throws InputError  if the network of the database was replaced since it was opened.
    std::vector<bool> add_trips(std::span<const NewTrip> trips);

    /// Records the start of an import in a journal.
    ///
    /// \param name  identifies the request, so that a repeated request finds its journal entry.
    /// \returns the progress of an import of that name that started and did not finish: it was
    /// killed, stopped, or is still running.
    std::optional<OpenImport> begin_import(const std::string& name, std::size_t trips_asked);

    /// Removes the journal entry of a finished import.
    void end_import(const std::string& name);

    /// Aligns and fuses the passes of every chunk that has passes newer than its segment states
    /// (mapping/alignment/alignment.hpp, mapping/fusion/fusion.hpp), by the rules of the current
    /// generation. \returns the number of segments with new passes.
    std::size_t refresh(const Progress& progress = {});

    /// Does so as a part of an import that fuses several times.
    std::size_t refresh(const Progress& progress, FusionRecord& record);

private:
    std::shared_ptr<StoreConnection> store_;
};

} // namespace macadam
