#include "app/import_trips.hpp"

#include "app/trip_place.hpp"

#include "estimator/common/error.hpp"
#include "storage/network_file.hpp"

#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <condition_variable>
#include <exception>
#include <map>
#include <mutex>
#include <new>
#include <thread>

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
    // The name of a car's own file is its vehicle_id, which the store does not keep.
    record.vehicle_model = outcome.built_in_vehicle ? outcome.vehicle : std::string{own_file_model};
    record.method = method == Method::kf ? "kf" : "smoother";
    record.distance_mm = thousandths(outcome.trip.distance_m);
    record.matched_mm = thousandths(outcome.trip.matched_m);
    record.rows_read = outcome.trip.rows.read;
    record.rows_used = outcome.trip.rows.used;
    record.row_reasons = outcome.trip.rows.reasons;
    return record;
}

/// What to say of a trip that is in the store already.
std::vector<std::string> spoken_known(const PipelineConfig& config) {
    if (config.trim_m > 0) {
        return {"stays as it was imported: its ends are not left out after the fact; a new store "
                "has to be made for that"};
    }
    return {};
}

/// One trip from file to passes. What is wrong with it becomes part of the outcome.
TripOutcome worked_out(const TripSource& source,
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
        outcome.trip = naming(outcome.file, [&] {
            return passes_of(std::move(trip), chosen.vehicle, roads, config);
        });
        outcome.record = record_of(source, meta, outcome, config.estimator.method);
        outcome.result = TripOutcome::Result::imported;
        if (!chosen.warning.empty()) {
            outcome.trip.warnings.push_back(chosen.warning);
        }
        if (!meta.t0_utc_s) {
            outcome.trip.warnings.emplace_back("t0_utc is not known: the trip counts as undated");
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

/// Workers take trips in order and hand outcomes back under their number; the writer takes them in
/// order. Workers stay at most `ahead` trips before the writer, so that memory is bounded.
class Workshop {
public:
    using Work = std::function<TripOutcome(std::size_t)>;

    Workshop(std::size_t count, std::size_t jobs, Work work)
        : count_{count}, ahead_{2 * jobs}, work_{std::move(work)} {
        for (std::size_t i = 0; i < jobs; ++i) {
            workers_.emplace_back([this](const std::stop_token& stop) { toil(stop); });
        }
    }

    TripOutcome take(std::size_t number) {
        std::unique_lock lock{mutex_};
        changed_.wait(lock, [&] { return done_.contains(number) || failure_; });
        if (failure_) {
            std::rethrow_exception(failure_);
        }
        auto outcome = std::move(done_.extract(number).mapped());
        taken_ = number + 1;
        changed_.notify_all();
        return outcome;
    }

private:
    void toil(const std::stop_token& stop) {
        try {
            for (std::size_t number = next_++; number < count_ && !stop.stop_requested();
                 number = next_++) {
                {
                    std::unique_lock lock{mutex_};
                    if (!changed_.wait(lock, stop, [&] { return number < taken_ + ahead_; })) {
                        return;
                    }
                }
                auto outcome = work_(number);
                const std::scoped_lock lock{mutex_};
                done_.emplace(number, std::move(outcome));
                changed_.notify_all();
            }
        } catch (...) {
            const std::scoped_lock lock{mutex_};
            failure_ = std::current_exception();
            changed_.notify_all();
        }
    }

    std::size_t count_;
    std::size_t ahead_;
    Work work_;
    std::atomic<std::size_t> next_ = 0;
    std::mutex mutex_;
    std::condition_variable_any changed_;
    std::map<std::size_t, TripOutcome> done_;
    std::size_t taken_ = 0;
    std::exception_ptr failure_;
    std::vector<std::jthread> workers_; // last: they stop before what they use goes
};

} // namespace

std::string_view name_of(TripOutcome::Result result) {
    switch (result) {
    case TripOutcome::Result::imported:
        return "imported";
    case TripOutcome::Result::known:
        return "known";
    case TripOutcome::Result::rejected:
        break;
    }
    return "rejected";
}

ImportTotals import_trips(RoadStore& store,
                          const std::vector<TripSource>& trips,
                          VehicleChoice& vehicles,
                          const PipelineConfig& config,
                          std::size_t jobs,
                          const Progress& progress,
                          const std::function<void(const TripOutcome&)>& tell) {
    const auto roads = kept_roads(store);
    std::mutex store_in_use;

    const auto work = [&](std::size_t number) {
        TripOutcome outcome;
        outcome.file = trips[number].name();
        try {
            outcome.sha256 = content_sha256(trips[number]);
        } catch (const std::exception& error) {
            outcome.error = error.what();
            return outcome;
        }
        {
            const std::scoped_lock lock{store_in_use};
            if (store.knows_trip(outcome.sha256)) {
                outcome.result = TripOutcome::Result::known;
                outcome.trip.warnings = spoken_known(config);
                return outcome;
            }
        }
        return worked_out(trips[number], outcome.sha256, vehicles, roads, config, progress.stop);
    };

    ImportTotals totals;
    Workshop workshop{trips.size(), jobs, work};
    for (std::size_t i = 0; i < trips.size(); ++i) {
        if (progress.stop.stop_requested()) {
            totals.left = trips.size() - i;
            break;
        }
        auto outcome = workshop.take(i);
        if (progress.stop.stop_requested() && outcome.result == TripOutcome::Result::rejected) {
            totals.left = trips.size() - i; // rejected only for being stopped, it may be
            break;
        }
        if (outcome.result == TripOutcome::Result::imported) {
            const std::scoped_lock lock{store_in_use};
            if (!store.add_trip(outcome.record, outcome.trip.passes, outcome.trip.traces)) {
                outcome.result = TripOutcome::Result::known; // twice in one call
            }
        }
        totals.imported += outcome.result == TripOutcome::Result::imported ? 1U : 0U;
        totals.known += outcome.result == TripOutcome::Result::known ? 1U : 0U;
        totals.rejected += outcome.result == TripOutcome::Result::rejected ? 1U : 0U;
        totals.passes +=
            outcome.result == TripOutcome::Result::imported ? outcome.trip.passes.size() : 0U;
        tell(outcome);
        progress(i + 1, trips.size());
    }
    return totals;
}

} // namespace macadam
