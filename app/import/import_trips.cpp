#include "app/import/import_trips.hpp"

#include "app/import/commit_batch.hpp"
#include "app/import/trip_processing.hpp"
#include "app/import/trip_progress.hpp"
#include "app/parallel/ordered_worker_pool.hpp"
#include "app/pipeline/privacy_trim.hpp"

#include "storage/networks/network_file.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>
#include <string_view>
#include <utility>

namespace macadam {
namespace {

bool has_passes(const TripReport& report) {
    return report.result == TripReport::Result::imported ||
           report.result == TripReport::Result::reprocessed;
}

/// Writes the trips that have passes. The same trip may occur twice; the second one is then known.
void put(const ImportContext& context, std::vector<ProcessedTrip>& trips) {
    using Result = TripReport::Result;
    std::vector<ProcessedTrip*> made;
    for (auto& trip : trips) {
        if (has_passes(trip.report)) {
            made.push_back(&trip);
        }
    }
    if (made.empty()) {
        return;
    }
    const std::scoped_lock lock{context.store_in_use};
    if (context.work.restaged != nullptr) {
        for (auto* const trip : made) {
            auto& report = trip->report;
            if (!context.work.restaged->stage_trip(
                    {&trip->record, trip->passes, trip->traces, false, trip->events})) {
                report.result = Result::unknown;
            }
        }
        return;
    }
    std::vector<NewTrip> together;
    for (const auto* const trip : made) {
        together.push_back(
            {&trip->record, trip->passes, trip->traces, context.work.readmit, trip->events});
    }
    const auto is_new = context.store.trips->add_trips(together);
    for (std::size_t i = 0; i < made.size(); ++i) {
        made[i]->report.result = is_new[i] ? Result::imported : Result::known;
    }
}

using Clock = std::chrono::steady_clock;
using TripPool = OrderedWorkerPool<TripSource, ProcessedTrip>;

void add(ImportTotals& totals, const TripReport& report) {
    const bool is_taken = has_passes(report);
    const bool is_rejected = report.result == TripReport::Result::rejected;
    const bool is_outside = report.result == TripReport::Result::outside;
    totals.imported += is_taken ? 1U : 0U;
    totals.rejected += is_rejected ? 1U : 0U;
    totals.known += !is_taken && !is_rejected && !is_outside ? 1U : 0U;
    totals.passes += is_taken ? report.passes : 0U;
    if (is_outside) {
        totals.outside.push_back(*report.outside_at);
    }
    if (!report.earlier_settings.empty()) {
        ++totals.earlier_settings[report.earlier_settings];
    }
}

/// Import of many trips: workers read and estimate, the caller's thread commits, fuses and reports.
class TripImport {
public:
    TripImport(const ImportContext& context,
               AskedTrips& trips,
               const Progress& progress,
               const std::function<void(const TripReport&)>& tell)
        : context_{context}, trips_{trips}, progress_{progress}, tell_{tell},
          pool_{[this] { return trips_.next(); },
                context.work.jobs,
                [this](const TripSource& source) { return process_trip(context_, source); }} {}

    ImportTotals run() {
        const auto& stop = progress_.stop;
        for (std::size_t i = 0;; ++i) {
            if (stop.stop_requested() && trips_.count() != i) {
                totals_.interrupted = true;
                break;
            }
            auto taken = take(i);
            if (taken.over) {
                break;
            }
            // After a stop a trip is possibly rejected only because of the stop.
            if (!taken.result || (stop.stop_requested() &&
                                  taken.result->report.result == TripReport::Result::rejected)) {
                totals_.interrupted = true;
                break;
            }
            batch_.add(std::move(*taken.result));
            if (batch_.is_full() || totals_.looked_at() == 0) { // the first report comes soon
                commit();
                fuse_if_due();
            }
        }
        commit();
        return std::move(totals_);
    }

private:
    /// Waits for a trip. Earlier ones do not wait for a long one: they are committed and fused.
    TripPool::Taken take(std::size_t number) {
        constexpr std::chrono::milliseconds look_every{250};
        for (;;) {
            const auto look = Clock::now() + look_every;
            auto taken =
                pool_.take(number, std::min(batch_.due().value_or(look), look), progress_.stop);
            if (taken.result || taken.over || progress_.stop.stop_requested()) {
                return taken;
            }
            if (batch_.is_full()) {
                commit();
            }
            fuse_if_due();
            show_progress();
        }
    }

    void commit() {
        auto together = batch_.empty();
        put(context_, together);
        for (const auto& trip : together) {
            add(totals_, trip.report);
            tell_(trip.report);
            has_unfused_ = has_unfused_ || has_passes(trip.report);
        }
        show_progress();
    }

    void fuse_if_due() {
        if (!has_unfused_ || context_.work.restaged != nullptr || Clock::now() < fuse_at_) {
            return;
        }
        const auto begin = Clock::now();
        const std::scoped_lock lock{context_.store_in_use};
        context_.store.trips->refresh(
            {.report = {}, .stop = progress_.stop}, totals_.fusion, BusyChunks::leave);
        has_unfused_ = false;
        fuse_at_ = Clock::now() +
                   std::max<Clock::duration>(context_.work.fuse_every, 4 * (Clock::now() - begin));
    }

    void show_progress() const {
        const auto whole = std::max(totals_.looked_at(), trips_.at_least());
        progress_(context_.done, whole * TripProgress::whole_trip);
    }

    const ImportContext& context_;
    AskedTrips& trips_;
    const Progress& progress_;
    const std::function<void(const TripReport&)>& tell_;
    ImportTotals totals_;
    CommitBatch batch_;
    bool has_unfused_ = false;
    Clock::time_point fuse_at_ = Clock::now() + context_.work.fuse_every;
    TripPool pool_; // last member: its workers use the others
};

} // namespace

std::string_view name_of(TripReport::Result result) {
    switch (result) {
    case TripReport::Result::imported:
        return "imported";
    case TripReport::Result::known:
        return "known";
    case TripReport::Result::reprocessed:
        return "reprocessed";
    case TripReport::Result::unknown:
        return "unknown";
    case TripReport::Result::outside:
        return "outside";
    case TripReport::Result::rejected:
        break;
    }
    return "rejected";
}

ImportTotals import_trips(ImportStore& store,
                          AskedTrips& trips,
                          VehicleChoice& vehicles,
                          const ImportWork& asked,
                          const Progress& progress,
                          const std::function<void(const TripReport&)>& tell) {
    const auto roads = load_or_build_network(store.map, asked.warn);
    auto work = asked;
    work.pipeline.trim = trim_in(store, asked.pipeline.trim);
    std::mutex store_in_use;
    std::atomic<std::size_t> done = 0;
    const ImportContext context{store, store_in_use, vehicles, roads, work, progress.stop, done};
    return TripImport{context, trips, progress, tell}.run();
}

} // namespace macadam
