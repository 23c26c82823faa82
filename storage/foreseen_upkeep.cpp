#include "storage/foreseen_upkeep.hpp"

#include "estimator/common/error.hpp"
#include "storage/staged_strips.hpp"
#include "storage/store_moment.hpp"
#include "storage/strip_fusion.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <utility>

namespace macadam {
namespace {

constexpr int most_begins = 2;         // beside the store, before it is done under the lock
constexpr int most_rounds = 5;         // after trips that came in meanwhile
constexpr std::size_t few_strips = 20; // fused in a blink

/// The store as it will be is seen while this lives.
class Foresight {
public:
    Foresight(Database& database, const Upkeep& upkeep) : database_{&database}, upkeep_{&upkeep} {}
    Foresight(const Foresight&) = delete;
    Foresight& operator=(const Foresight&) = delete;
    ~Foresight() { sqlite3_exec(database_->handle(), upkeep_->unsee, nullptr, nullptr, nullptr); }

private:
    Database* database_;
    const Upkeep* upkeep_;
};

/// What was foreseen, and when.
struct Foreseen {
    StoreMoment moment;
    std::vector<std::int64_t> strips; ///< whose states change by the upkeep
};

class Work {
public:
    Work(Database& database,
         std::int64_t segments_in_strip,
         const ClassTable& classes,
         const Upkeep& upkeep,
         const Progress& progress)
        : database_{&database}, segments_in_strip_{segments_in_strip}, classes_{&classes},
          upkeep_{&upkeep}, progress_{&progress}, staged_{database} {}

    bool carry_out() {
        for (int i = 0; i < most_begins; ++i) {
            const auto foreseen = foresee();
            if (!foreseen) {
                return false;
            }
            Transaction all{*database_, Transaction::Kind::write};
            if (moment_of(*database_).upkeep == foreseen->moment.upkeep) {
                put_in_place(*foreseen);
                all.commit();
                return true;
            }
        }
        return carry_out_under_the_lock();
    }

private:
    std::optional<Foreseen> foresee() {
        const Foresight foresight{*database_, *upkeep_};
        auto foreseen = foresee_all();
        for (int i = 0; foreseen && i < most_rounds && fuse_what_came(*foreseen) > few_strips;
             ++i) {
        }
        return foreseen;
    }

    std::optional<Foreseen> foresee_all() {
        staged_.clear();
        Transaction moment{*database_, Transaction::Kind::read};
        Foreseen foreseen{moment_of(*database_), {}};
        auto strips = upkeep_->foresee();
        if (!strips) {
            return std::nullopt;
        }
        foreseen.strips = std::move(*strips);
        auto wanted = dirty_strips(*database_);
        wanted.insert(wanted.end(), foreseen.strips.begin(), foreseen.strips.end());
        std::ranges::sort(wanted);
        wanted.erase(std::ranges::unique(wanted).begin(), wanted.end());
        fuse(wanted);
        moment.commit();
        return foreseen;
    }

    /// \returns how many strips there were to fuse.
    std::size_t fuse_what_came(Foreseen& foreseen) {
        Transaction moment{*database_, Transaction::Kind::read};
        const auto now = moment_of(*database_);
        if (now.upkeep != foreseen.moment.upkeep || now.last_trip == foreseen.moment.last_trip) {
            return 0;
        }
        const auto strips = strips_driven_since(*database_, foreseen.moment);
        staged_.remove(strips);
        fuse(strips);
        moment.commit();
        foreseen.moment = now;
        return strips.size();
    }

    void fuse(const std::vector<std::int64_t>& strips) {
        StripStates states{*database_};
        for (std::size_t i = 0; i < strips.size(); ++i) {
            expect_to_go_on();
            staged_.put(strips[i], states.of(strips[i], segments_in_strip_));
            (*progress_)(i, strips.size());
        }
    }

    void put_in_place(const Foreseen& foreseen) {
        const auto came = strips_driven_since(*database_, foreseen.moment);
        staged_.remove(came);
        const auto audit = upkeep_->apply();
        auto mark = database_->prepare("INSERT OR IGNORE INTO strip_dirty VALUES (?)");
        for (const auto* const strips : {&foreseen.strips, &came}) {
            for (const auto strip : *strips) {
                mark.run(strip);
            }
        }
        fuse_dirty_at_once(*database_, {segments_in_strip_, classes_, audit, &staged_}, *progress_);
    }

    bool carry_out_under_the_lock() {
        staged_.clear();
        Transaction all{*database_, Transaction::Kind::write};
        Foreseen foreseen{moment_of(*database_), {}};
        auto strips = upkeep_->foresee();
        database_->run(upkeep_->unsee);
        if (!strips) {
            return false;
        }
        foreseen.strips = std::move(*strips);
        put_in_place(foreseen);
        all.commit();
        return true;
    }

    void expect_to_go_on() const {
        if (progress_->stop.stop_requested()) {
            throw InputError{
                fmt::format("{}: interrupted; the store is as it was", database_->file().string())};
        }
    }

    Database* database_;
    std::int64_t segments_in_strip_;
    const ClassTable* classes_;
    const Upkeep* upkeep_;
    const Progress* progress_;
    StagedStrips staged_;
};

} // namespace

bool carry_out(Database& database,
               std::int64_t segments_in_strip,
               const ClassTable& classes,
               const Upkeep& upkeep,
               const Progress& progress) {
    return Work{database, segments_in_strip, classes, upkeep, progress}.carry_out();
}

} // namespace macadam
