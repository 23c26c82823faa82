#include "app/import/import_trips.hpp"

#include "app/pipeline/privacy_trim.hpp"
#include "app/pipeline/single_trip.hpp"

#include "estimator/common/error.hpp"
#include "storage/networks/network_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <exception>
#include <map>
#include <mutex>
#include <new>
#include <optional>
#include <span>
#include <thread>
#include <utility>

namespace macadam {
namespace {

std::int64_t thousandths(double value) {
    return std::llround(value * 1000);
}

TripRecord record_of(const TripSource& source,
                     const TripMeta& meta,
                     const TripOutcome& outcome,
                     Method method) {
    TripRecord record;
    record.sha256 = outcome.sha256;
    record.trip_id = meta.trip_id;
    record.vehicle_id = meta.vehicle_id;
    record.file_name = source.file.filename().string();
    if (meta.t0_utc_s && outcome.trip.begin_ms) {
        record.t0_utc_ms = thousandths(*meta.t0_utc_s) + *outcome.trip.begin_ms;
    }
    // A car from a user's file is named after its vehicle_id, which the database does not keep.
    record.vehicle_model = outcome.built_in_vehicle ? outcome.vehicle : std::string{own_file_model};
    record.method = method == Method::kf ? "kf" : "smoother";
    record.distance_mm = thousandths(outcome.trip.distance_m);
    record.matched_mm = thousandths(outcome.trip.matched_m);
    record.rows_read = outcome.trip.rows.read;
    record.rows_used = outcome.trip.rows.used;
    record.row_reasons = outcome.trip.rows.reasons;
    return record;
}

/// Returns the messages for a trip that is already in the database.
std::vector<std::string> known_text(const PipelineConfig& config) {
    if (config.trim.is_active() && !config.trim.hides_places) {
        return {"was imported before and stays unchanged: its ends cannot be removed "
                "afterwards; import it into a new database for that"};
    }
    return {};
}

/// Processes one trip from file to passes. Errors become part of the outcome.
TripOutcome process_trip(const TripSource& source,
                         const std::string& sha256,
                         VehicleChoice& vehicles,
                         const RoadNetwork& roads,
                         const PipelineConfig& config,
                         const std::stop_token& stop) {
    TripOutcome outcome;
    outcome.file = source.name();
    outcome.sha256 = sha256;
    try {
        auto trip = read_trip(source, needs_of_import(), {.report = {}, .stop = stop});
        const auto meta = trip.meta;
        outcome.sha256 = trip.sha256;
        outcome.trip_id = meta.trip_id;
        const auto chosen = vehicles(source.file, meta.vehicle_id);
        outcome.vehicle = chosen.vehicle.name;
        outcome.built_in_vehicle = chosen.built_in;
        outcome.trip.rows.read = outcome.trip.rows.rejected = trip.rows.size();
        outcome.trip = with_trip_name(outcome.file, [&] {
            return passes_of(std::move(trip), chosen.vehicle, roads, config);
        });
        outcome.record = record_of(source, meta, outcome, config.estimator.method);
        outcome.result = TripOutcome::Result::imported;
        if (!chosen.warning.empty()) {
            outcome.trip.warnings.push_back(chosen.warning);
        }
        if (!meta.t0_utc_s) {
            outcome.trip.warnings.emplace_back("no date in the log (t0_utc): date filters "
                                               "ignore this trip");
        }
    } catch (const std::bad_alloc&) {
        outcome.error = outcome.file + ": not enough memory";
    } catch (const std::exception& error) {
        outcome.error = error.what();
    }
    if (outcome.result == TripOutcome::Result::rejected && outcome.trip.rows.read > 0) {
        outcome.trip.rows.reasons = {{"trip_rejected", outcome.trip.rows.read}};
    }
    return outcome;
}

using Clock = std::chrono::steady_clock;
using Deadline = std::optional<Clock::time_point>; ///< `std::nullopt`: none

/// Worker pool that returns the outcomes in the order of the trips. Workers stay at most `ahead`
/// trips before the writer, so that memory is bounded.
class OrderedWorkerPool {
public:
    using Supply = std::function<std::optional<TripSource>()>;
    using Work = std::function<TripOutcome(const TripSource&)>;

    OrderedWorkerPool(Supply supply, std::size_t jobs, Work work)
        : ahead_{2 * jobs}, supply_{std::move(supply)}, work_{std::move(work)} {
        for (std::size_t i = 0; i < jobs; ++i) {
            workers_.emplace_back([this](const std::stop_token& stop) { worker_loop(stop); });
        }
    }

    struct Taken {
        std::optional<TripOutcome> outcome; ///< `std::nullopt`: not ready yet, or over
        bool over = false;                  ///< there is no such trip
    };

    /// Waits for an outcome, until the deadline or a stop request at the latest.
    Taken take(std::size_t number, const Deadline& until, const std::stop_token& stop) {
        constexpr std::chrono::milliseconds look_every{50};
        std::unique_lock lock{mutex_};
        const auto is_over = [&] { return count_ && number >= *count_; };
        const auto is_there = [&] { return done_.contains(number) || failure_ || is_over(); };
        while (!changed_.wait_for(lock, look_every, is_there)) {
            if (stop.stop_requested() || (until && Clock::now() >= *until)) {
                return {};
            }
        }
        if (failure_) {
            std::rethrow_exception(failure_);
        }
        if (is_over()) {
            return {.outcome = {}, .over = true};
        }
        auto outcome = std::move(done_.extract(number).mapped());
        taken_ = number + 1;
        changed_.notify_all();
        return {.outcome = std::move(outcome)};
    }

private:
    struct Task {
        std::size_t number;
        TripSource trip;
    };

    /// Takes the next trip when there is room for it. Only one worker at a time asks, to keep the
    /// order; the others continue while it is extracted from an archive.
    std::optional<Task> next_task(const std::stop_token& stop) {
        const std::scoped_lock asking{asking_};
        {
            std::unique_lock lock{mutex_};
            const auto has_room = [&] { return given_ < taken_ + ahead_; };
            if (!changed_.wait(lock, stop, has_room) || stop.stop_requested() || count_) {
                return std::nullopt;
            }
        }
        auto trip = supply_();
        const std::scoped_lock lock{mutex_};
        if (!trip) {
            count_ = given_;
            changed_.notify_all();
            return std::nullopt;
        }
        return Task{given_++, std::move(*trip)};
    }

    void worker_loop(const std::stop_token& stop) {
        try {
            while (auto task = next_task(stop)) {
                auto outcome = work_(task->trip);
                const std::scoped_lock lock{mutex_};
                done_.emplace(task->number, std::move(outcome));
                changed_.notify_all();
            }
        } catch (...) {
            const std::scoped_lock lock{mutex_};
            failure_ = std::current_exception();
            changed_.notify_all();
        }
    }

    std::size_t ahead_;
    Supply supply_;
    Work work_;
    std::mutex asking_;
    std::mutex mutex_;
    std::condition_variable_any changed_;
    std::map<std::size_t, TripOutcome> done_;
    std::size_t given_ = 0;
    std::size_t taken_ = 0;
    std::optional<std::size_t> count_; ///< total, once known
    std::exception_ptr failure_;
    // Last member: workers stop before the members they use are destroyed.
    std::vector<std::jthread> workers_;
};

/// Callbacks of an import or a reprocessing. They have exclusive use of the database.
struct ImportMode {
    using Result = TripOutcome::Result;
    /// Returns the result and the messages of a trip that is to be skipped.
    std::function<std::optional<std::pair<Result, std::vector<std::string>>>(const std::string&)>
        leave;
    /// Stores the trips and sets their results.
    std::function<void(std::span<TripOutcome* const>)> take;
};

// A commit takes the same disk time for one trip as for many. Uncommitted trips must be processed
// again after a kill.
constexpr std::size_t most_together = 100; // trips
constexpr std::size_t max_passes_together = 50'000;
constexpr std::chrono::seconds longest_together{1};

/// Outcomes that are committed together and then reported, in their order.
class CommitBatch {
public:
    void add(TripOutcome outcome) {
        if (outcomes_.empty()) {
            due_ = Clock::now() + longest_together;
        }
        passes_ += outcome.trip.passes.size();
        outcomes_.push_back(std::move(outcome));
    }

    /// Time of the next commit; `std::nullopt` if no outcome waits.
    Deadline due() const { return outcomes_.empty() ? Deadline{} : due_; }

    bool is_full() const {
        return outcomes_.size() >= most_together || passes_ >= max_passes_together ||
               (!outcomes_.empty() && Clock::now() >= due_);
    }

    /// Returns the outcomes that gave a result.
    std::vector<TripOutcome*> made() {
        std::vector<TripOutcome*> made;
        for (auto& outcome : outcomes_) {
            if (outcome.result == TripOutcome::Result::imported) {
                made.push_back(&outcome);
            }
        }
        return made;
    }

    std::vector<TripOutcome> empty() {
        passes_ = 0;
        return std::exchange(outcomes_, {});
    }

private:
    std::vector<TripOutcome> outcomes_;
    std::size_t passes_ = 0;
    Clock::time_point due_;
};

void add(ImportTotals& totals, const TripOutcome& outcome) {
    using Result = TripOutcome::Result;
    const bool is_taken =
        outcome.result == Result::imported || outcome.result == Result::reprocessed;
    const bool is_rejected = outcome.result == Result::rejected;
    totals.imported += is_taken ? 1U : 0U;
    totals.rejected += is_rejected ? 1U : 0U;
    totals.known += !is_taken && !is_rejected ? 1U : 0U;
    totals.passes += is_taken ? outcome.trip.passes.size() : 0U;
}

ImportTotals process_trips(const ImportMode& purpose,
                           const RoadNetwork& roads,
                           AskedTrips& trips,
                           VehicleChoice& vehicles,
                           const PipelineConfig& config,
                           std::size_t jobs,
                           const Progress& progress,
                           const std::function<void(const TripOutcome&)>& tell) {
    using Result = TripOutcome::Result;
    std::mutex store_in_use;
    const auto work = [&](const TripSource& trip) {
        TripOutcome outcome;
        outcome.file = trip.name();
        try {
            outcome.sha256 = content_sha256(trip);
        } catch (const std::exception& error) {
            outcome.error = error.what();
            return outcome;
        }
        {
            const std::scoped_lock lock{store_in_use};
            if (auto left = purpose.leave(outcome.sha256)) {
                outcome.result = left->first;
                outcome.trip.warnings = std::move(left->second);
                return outcome;
            }
        }
        return process_trip(trip, outcome.sha256, vehicles, roads, config, progress.stop);
    };

    ImportTotals totals;
    OrderedWorkerPool workshop{[&] { return trips.next(); }, jobs, work};
    CommitBatch batch;
    std::size_t told = 0;
    const auto commit = [&] {
        if (const auto made = batch.made(); !made.empty()) {
            const std::scoped_lock lock{store_in_use};
            purpose.take(made);
        }
        for (const auto& outcome : batch.empty()) {
            add(totals, outcome);
            tell(outcome);
            progress(++told, std::max(told, trips.at_least()));
        }
    };
    for (std::size_t i = 0;; ++i) {
        if (progress.stop.stop_requested() && trips.count() != i) {
            totals.interrupted = true;
            break;
        }
        auto taken = workshop.take(i, batch.due(), progress.stop);
        if (!taken.outcome && !taken.over) { // a long trip: earlier ones do not wait for it
            commit();
            taken = workshop.take(i, {}, progress.stop);
        }
        if (!taken.outcome && !taken.over) {
            totals.interrupted = true;
            break;
        }
        if (taken.over) {
            break;
        }
        if (progress.stop.stop_requested() && taken.outcome->result == Result::rejected) {
            totals.interrupted = true; // possibly rejected only because of the stop
            break;
        }
        batch.add(std::move(*taken.outcome));
        if (batch.is_full() || told == 0) { // the first report comes soon
            commit();
        }
    }
    commit();
    return totals;
}

} // namespace

std::string_view name_of(TripOutcome::Result result) {
    switch (result) {
    case TripOutcome::Result::imported:
        return "imported";
    case TripOutcome::Result::known:
        return "known";
    case TripOutcome::Result::reprocessed:
        return "reprocessed";
    case TripOutcome::Result::unknown:
        return "unknown";
    case TripOutcome::Result::rejected:
        break;
    }
    return "rejected";
}

ImportTotals import_trips(RoadStore& store,
                          AskedTrips& trips,
                          VehicleChoice& vehicles,
                          const PipelineConfig& asked,
                          const ImportWork& work,
                          const Progress& progress,
                          const std::function<void(const TripOutcome&)>& tell) {
    using Result = TripOutcome::Result;
    const auto roads = load_or_build_network(store, work.warn);
    auto config = asked;
    config.trim = trim_in(store, asked.trim);
    const ImportMode purpose{
        .leave = [&](const std::string& sha256)
            -> std::optional<std::pair<Result, std::vector<std::string>>> {
            if (store.contains_trip(sha256)) {
                return std::pair{Result::known, known_text(config)};
            }
            if (!work.readmit && store.has_forgotten(sha256)) {
                return std::pair{
                    Result::known,
                    std::vector<std::string>{
                        "was permanently deleted on request; --take-back re-admits it"}};
            }
            return std::nullopt;
        },
        .take =
            [&](std::span<TripOutcome* const> outcomes) {
                std::vector<NewTrip> together;
                for (const auto* outcome : outcomes) {
                    together.push_back({&outcome->record,
                                        outcome->trip.passes,
                                        outcome->trip.traces,
                                        work.readmit,
                                        outcome->trip.events});
                }
                const auto is_new = store.importer.add_trips(together);
                for (std::size_t i = 0; i < outcomes.size(); ++i) { // a call may repeat a trip
                    outcomes[i]->result = is_new[i] ? Result::imported : Result::known;
                }
            }};
    return process_trips(purpose, roads, trips, vehicles, config, work.jobs, progress, tell);
}

ImportTotals reprocess_trips(RoadStore& store,
                             AskedTrips& trips,
                             VehicleChoice& vehicles,
                             const PipelineConfig& asked,
                             std::size_t jobs,
                             const Progress& progress,
                             const std::function<void(const TripOutcome&)>& tell) {
    using Result = TripOutcome::Result;
    const auto roads = load_or_build_network(store);
    auto config = asked;
    config.trim = trim_in(store, asked.trim);
    const ImportMode purpose{
        .leave = [&](const std::string& sha256)
            -> std::optional<std::pair<Result, std::vector<std::string>>> {
            if (store.contains_trip(sha256)) {
                return std::nullopt;
            }
            return std::pair{
                Result::unknown,
                std::vector<std::string>{"is not in the database: import it with 'macadam "
                                         "import'"}};
        },
        .take =
            [&](std::span<TripOutcome* const> outcomes) {
                for (auto* const outcome : outcomes) {
                    const auto& trip = outcome->trip;
                    const bool is_kept = store.maintenance.stage_trip(
                        {&outcome->record, trip.passes, trip.traces, false, trip.events});
                    outcome->result = is_kept ? Result::reprocessed : Result::unknown;
                }
            }};
    return process_trips(purpose, roads, trips, vehicles, config, jobs, progress, tell);
}

} // namespace macadam
