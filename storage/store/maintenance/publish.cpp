#include "estimator/common/error.hpp"
#include "mapping/fusion/utc_month.hpp"
#include "storage/store/connection/store_connection.hpp"
#include "storage/store/fusion/store_version.hpp"
#include "storage/store/maintenance/store_maintenance.hpp"
#include "storage/store/publication/publication_rows.hpp"
#include "storage/store/publication/staged_publication.hpp"
#include "storage/store/rows/audit.hpp"
#include "storage/text/utc.hpp"

#include <fmt/format.h>

namespace macadam {
namespace {

constexpr std::size_t month_letters = 7; // 2026-11
constexpr int max_attempts = 4; // beside others, before it is computed under the write lock

} // namespace

Published StoreMaintenance::publish(const RoadNetwork& roads,
                                    std::int64_t now_utc_ms,
                                    const Progress& progress) {
    auto& database = store_->database;
    const auto refuse = [&](std::string_view why) {
        throw InputError{fmt::format("{}: {}", database.file().string(), why)};
    };
    if (store_->settings.privacy != PrivacyProfile::crowd) {
        refuse("is a database of the operator's own cars (privacy: own), expected a crowd "
               "database; its content can be exported without publishing");
    }
    if (!store_->key) {
        refuse(fmt::format("its key is not at {}, expected the operator's: who holds the key "
                           "publishes",
                           store_->key_file.string()));
    }
    const auto month = utc_text(now_utc_ms).substr(0, month_letters);
    const auto expect_due = [&] {
        store_->expect_same_network();
        if (const auto latest = macadam::latest_publication(database);
            latest && latest->month >= month) {
            refuse(
                fmt::format("was already published in {}, and can be published once a month; the "
                            "next publication is possible from {} on",
                            latest->month,
                            utc_text(next_month_ms(now_utc_ms)).substr(0, month_letters)));
        }
    };
    const PublicationWork work{&roads,
                               &*store_->key,
                               &store_->classes(),
                               store_->segments_per_chunk(),
                               store_->part_to_publish ? &*store_->part_to_publish : nullptr};
    StagedPublication staged{database};
    const auto compute = [&] {
        Transaction snapshot{database, Transaction::Kind::read};
        expect_due();
        const auto version = moment_of(database);
        staged.compute(work, progress);
        snapshot.commit();
        return version;
    };
    for (int attempt = 1;; ++attempt) {
        const auto version = compute();
        Transaction all{database, Transaction::Kind::write};
        expect_due();
        if (moment_of(database).maintenance != version.maintenance) { // passes or rules changed
            if (attempt < max_attempts) {
                continue;
            }
            staged.compute(work, progress);
        }
        auto done = staged.apply(month);
        add_audit(database, "publish", fmt::format("publication {}", done.publication.number));
        all.commit();
        store_->written(progress);
        return done;
    }
}

} // namespace macadam
