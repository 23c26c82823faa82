#include "support/files/files.hpp"
#include "support/roads/crowd_drives.hpp"
#include "support/roads/store_world.hpp"

#include "storage/sqlite/sqlite.hpp"
#include "storage/store/schema/schema_check.hpp"
#include "storage/store/upgrade/store_upgrade.hpp"

#include <gmock/gmock.h>
#include <sqlite3.h>

#include <functional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

namespace macadam {
namespace {

using testing::add_trip;
using testing::CrowdDrive;
using testing::day_ms;
using testing::february_ms;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::january_ms;
using testing::march_ms;
using testing::refusal_of;
using testing::roads_in_a_row;
using testing::test_folder;

struct Crowd {
    std::filesystem::path file;
    RoadStore store;

    explicit Crowd(PrivacyProfile privacy = PrivacyProfile::crowd)
        : file{test_folder() / "crowd.gpkg"}, store{RoadStore::create(file,
                                                                      roads_in_a_row(3),
                                                                      {.network_source = "map",
                                                                       .attribution = "",
                                                                       .privacy = privacy})} {}

    /// \param holes  also reports a pothole at 55 m of the second road and one of the first
    void drive(int car, std::int64_t utc_ms, IriUm iri_um = 2000, bool holes = false) {
        drive_into(store, car, utc_ms, iri_um, holes);
    }
    void drive_into(
        RoadStore& to, int car, std::int64_t utc_ms, IriUm iri_um = 2000, bool holes = false) {
        const CrowdDrive drive{trips_++, car, utc_ms, iri_um, holes};
        add_trip(to, drive.record(), drive.passes(), {}, drive.events());
    }
    void drive_all(int cars, std::int64_t utc_ms, IriUm iri_um = 2000) {
        for (int car = 0; car < cars; ++car) {
            drive(car, utc_ms, iri_um);
        }
        store.importer.refresh();
    }
    /// Six cars drive by another program.
    void drive_beside(std::int64_t utc_ms, IriUm iri_um) {
        auto other = RoadStore::open(file);
        for (int car = 0; car < 6; ++car) {
            drive_into(other, car, utc_ms, iri_um);
        }
        other.importer.refresh();
    }
    Published publish(std::int64_t now_ms, const Progress& progress = {}) {
        return store.maintenance.publish(roads_in_a_row(3), now_ms, progress);
    }

    std::vector<SegmentRecord> seen(const std::optional<Period>& period = {},
                                    Audience audience = Audience::anyone) const {
        SegmentFilter filter;
        filter.period = period;
        std::vector<SegmentRecord> records;
        StoreReader::open(file, {}, audience).visit(filter, [&](const SegmentRecord& record) {
            if (record.state) {
                records.push_back(record);
            }
        });
        return records;
    }

    /// Rows of the layer that QGIS shows.
    std::int64_t layer_rows() const {
        Database database{file, Database::Access::read};
        sqlite3_db_config(database.handle(), SQLITE_DBCONFIG_ENABLE_VIEW, 1, nullptr);
        return database.number("SELECT count(*) FROM roughness WHERE iri > 0");
    }

    std::vector<EventRecord> events(Audience audience = Audience::anyone) const {
        return StoreReader::open(file, {}, audience).events({});
    }

private:
    int trips_ = 0;
};

TEST(Publication, TellsOfEventsThatFiveCarsReport) {
    Crowd crowd;
    for (int car = 0; car < 8; ++car) {
        crowd.drive(car, january_ms, 2000, car < 4);
    }
    crowd.store.importer.refresh();
    EXPECT_EQ(crowd.events(Audience::operator_).size(), 2U);
    EXPECT_THAT(crowd.events(), IsEmpty());
    crowd.publish(february_ms);
    EXPECT_THAT(crowd.events(), IsEmpty());

    for (int car = 4; car < 10; ++car) {
        crowd.drive(car, february_ms + 5 * day_ms, 2000, true);
    }
    crowd.store.importer.refresh();
    EXPECT_THAT(crowd.events(), IsEmpty()); // until the next publication
    crowd.publish(march_ms);
    const auto events = crowd.events();
    ASSERT_EQ(events.size(), 1U); // none at the end of the trips
    const auto& event = events.front().event;
    EXPECT_EQ(event.segment, (SegmentKey{2, true, 2}));
    EXPECT_EQ(event.at_mm, 55'000);
    EXPECT_EQ(event.size_um, 30'000);
    EXPECT_EQ(event.passes, 10);
    EXPECT_EQ(event.passes_over, 10);
    EXPECT_EQ(event.vehicles, 10);
    EXPECT_EQ(event.first_seen_ms, january_ms);
    EXPECT_EQ(event.last_seen_ms, february_ms);
}

TEST(Publication, HasNoEventsByMonth) {
    Crowd crowd;
    for (int car = 0; car < 6; ++car) {
        crowd.drive(car, january_ms, 2000, true);
    }
    crowd.store.importer.refresh();
    crowd.publish(february_ms);
    EXPECT_EQ(crowd.events().size(), 1U);
    SegmentFilter filter;
    filter.period = Period{january_ms, february_ms};
    const auto store = StoreReader::open(crowd.file);
    EXPECT_THAT(refusal_of([&] { store.events(filter); }),
                HasSubstr("expected no --since and --until"));
}

TEST(Publication, ComesBeforeAnythingLeavesACrowd) {
    Crowd crowd;
    crowd.drive_all(6, january_ms);
    EXPECT_THAT(crowd.seen(), IsEmpty());
    crowd.publish(february_ms);
    const auto seen = crowd.seen();
    ASSERT_EQ(seen.size(), 10U); // the roads at the ends of all trips are left out
    EXPECT_EQ(seen.front().segment.key.way_id, 2);
    EXPECT_EQ(seen.front().state->vehicles, 5);
    EXPECT_EQ(seen.front().state->first_seen_ms, january_ms);
}

TEST(Publication, IsTheLayerThatQgisShowsOfACrowd) {
    Crowd crowd;
    crowd.drive_all(6, january_ms);
    EXPECT_EQ(crowd.layer_rows(), 0);
    crowd.publish(february_ms);
    EXPECT_EQ(crowd.layer_rows(), 10);
}

TEST(Publication, IsTheLayerOfACrowdThatWasUpgraded) {
    Crowd crowd;
    crowd.drive_all(6, january_ms);
    Database{crowd.file, Database::Access::write}.run(
        "DROP VIEW roughness;" + own_schema(PrivacyProfile::own).at({"view", "roughness"}).sql +
        ";ALTER TABLE trip DROP COLUMN trimmed_mm; UPDATE meta SET value = '4' WHERE key = "
        "'version'");
    ASSERT_EQ(crowd.layer_rows(), 30);
    const auto done = upgrade_store(crowd.file, {}, [](auto) { return Progress{}; });
    EXPECT_EQ(done.to_version, 7);
    EXPECT_EQ(done.digest, crowd.store.digest());
    EXPECT_EQ(crowd.layer_rows(), 0);
    crowd.publish(february_ms);
    EXPECT_EQ(crowd.layer_rows(), 10);
}

TEST(Publication, ShowsTheOperatorMore) {
    Crowd crowd;
    crowd.drive_all(2, january_ms);
    EXPECT_EQ(crowd.seen({}, Audience::operator_).size(), 30U);
    std::filesystem::remove(key_file_of(crowd.file));
    EXPECT_THAT(crowd.seen({}, Audience::operator_), IsEmpty());
}

TEST(Publication, HidesAllThatTellsOfCars) {
    Crowd crowd;
    crowd.drive_all(6, january_ms);
    crowd.publish(february_ms);
    const auto store = StoreReader::open(crowd.file);
    EXPECT_THAT(store.history({2, true, 3}), IsEmpty());
    EXPECT_THAT(store.changes({2, true, 3}), IsEmpty());
    EXPECT_THAT(store.usage().vehicles, IsEmpty());
    EXPECT_THAT(store.usage().days, IsEmpty());
    EXPECT_THAT(store.audit(), IsEmpty());
    EXPECT_THAT(store.usage().calibrated_cars, IsEmpty());
    const auto info = store.info();
    EXPECT_THAT(info.vehicles, IsEmpty());
    EXPECT_EQ(info.trips, 5U); // at least
    EXPECT_EQ(info.segments_with_passes, 10U);
    ASSERT_TRUE(info.publication);
    EXPECT_EQ(info.publication->month, "2026-02");
    EXPECT_EQ(info.publication->left_out, 20U);
}

TEST(Publication, IsMadeOnceAMonth) {
    Crowd crowd;
    crowd.drive_all(6, january_ms);
    crowd.publish(february_ms);
    EXPECT_THAT(refusal_of([&] { crowd.publish(march_ms - 1); }),
                HasSubstr("was already published in 2026-02, and can be published once a "
                          "month; the next publication is possible from 2026-03 on"));
    crowd.publish(march_ms);
    EXPECT_EQ(crowd.store.latest_publication()->number, 2);
}

TEST(Publication, StaysAsItIsWhateverComesIn) {
    Crowd crowd;
    crowd.drive_all(6, january_ms);
    crowd.publish(february_ms);
    const auto before = crowd.seen();
    crowd.drive_all(6, february_ms, 5000);
    ASSERT_EQ(crowd.seen().size(), before.size());
    EXPECT_EQ(crowd.seen().front().state, before.front().state);
}

TEST(Publication, ChangesOnlyByFiveCarsAtOnce) {
    Crowd crowd;
    crowd.drive_all(6, january_ms);
    crowd.publish(february_ms);
    const auto before = crowd.seen();
    crowd.drive_all(4, february_ms, 5000);
    EXPECT_EQ(crowd.publish(march_ms).changed, 0U);
    EXPECT_EQ(crowd.seen().front().state, before.front().state);
}

TEST(Publication, TellsMonthsOfFiveCarsAlone) {
    Crowd crowd;
    crowd.drive_all(6, january_ms, 2000);
    crowd.drive_all(3, february_ms, 9000);
    crowd.publish(march_ms);
    const auto january = crowd.seen(Period{january_ms, february_ms});
    ASSERT_EQ(january.size(), 10U);
    EXPECT_EQ(january.front().state->iri_um, 2000);
    EXPECT_THAT(crowd.seen(Period{february_ms, march_ms}), IsEmpty());
    EXPECT_EQ(crowd.seen().front().state->iri_um, 2000); // nor does the whole tell of it
}

TEST(Publication, IsAskedForWholeMonths) {
    Crowd crowd;
    crowd.drive_all(6, january_ms);
    crowd.publish(february_ms);
    EXPECT_THAT(refusal_of([&] {
                    crowd.seen(Period{january_ms + day_ms, std::nullopt});
                }),
                HasSubstr("given by whole months"));
}

TEST(Publication, KeepsItsFiguresWhenACarIsForgottenUntilOthersDrove) {
    Crowd crowd;
    crowd.drive_all(6, january_ms);
    crowd.drive(7, january_ms, 9000);
    crowd.store.importer.refresh();
    crowd.publish(february_ms);
    const auto before = crowd.seen().front().state;
    ForgetRequest request;
    request.vehicles = {"car 7"};
    crowd.store.maintenance.forget(request);
    crowd.publish(march_ms);
    EXPECT_EQ(crowd.seen().front().state, before);
    crowd.drive_all(6, march_ms, 2000);
    crowd.publish(march_ms + 40 * day_ms);
    EXPECT_EQ(crowd.seen().front().state->iri_um, 2000);
}

// ---------------------------------------------------------------------------- beside other writers

/// Calls `act` once, while a publication is computed.
Progress meanwhile(const std::function<void()>& act) {
    return {.report =
                [act, is_first = true](std::size_t, std::size_t) mutable {
                    if (std::exchange(is_first, false)) {
                        act();
                    }
                },
            .stop = {}};
}

TEST(PublicationBesideOthers, LetsTripsComeInAndLeavesThemToTheNextOne) {
    Crowd crowd;
    crowd.drive_all(6, january_ms);
    bool came = false;
    const auto first = crowd.publish(february_ms, meanwhile([&] {
                                         crowd.drive_beside(february_ms, 5000);
                                         came = true;
                                     }));
    ASSERT_TRUE(came); // before it ended: it held no lock
    EXPECT_EQ(first.publication.trips, 5);
    ASSERT_EQ(crowd.seen().size(), 10U);
    EXPECT_EQ(crowd.seen().front().state->iri_um, 2000);
    const auto second = crowd.publish(march_ms);

    Crowd serial;
    serial.drive_all(6, january_ms);
    serial.publish(february_ms);
    serial.drive_beside(february_ms, 5000);
    const auto expected = serial.publish(march_ms);
    EXPECT_EQ(second.changed, expected.changed);
    EXPECT_EQ(second.publication.left_out, expected.publication.left_out);
    const auto seen = crowd.seen();
    const auto wanted = serial.seen();
    ASSERT_EQ(seen.size(), wanted.size());
    for (std::size_t i = 0; i < seen.size(); ++i) {
        EXPECT_EQ(seen[i].state, wanted[i].state);
    }
}

TEST(PublicationBesideOthers, IsComputedAgainWhenCarsWereForgottenMeanwhile) {
    Crowd crowd;
    crowd.drive_all(6, january_ms);
    const auto done = crowd.publish(february_ms, meanwhile([&] {
                                        ForgetRequest request;
                                        request.vehicles = {"car 1", "car 2"};
                                        RoadStore::open(crowd.file).maintenance.forget(request);
                                    }));
    EXPECT_EQ(done.changed, 0U); // four cars are left
    EXPECT_THAT(crowd.seen(), IsEmpty());
}

TEST(PublicationBesideOthers, LetsTripsComeInWhileItIsComputedAgain) {
    Crowd crowd;
    crowd.drive_all(8, january_ms);
    int begun = 0;
    const Progress beside{.report =
                              [&](std::size_t done, std::size_t) {
                                  if (done != 1) {
                                      return;
                                  }
                                  if (++begun == 1) {
                                      ForgetRequest request;
                                      request.vehicles = {"car 1"};
                                      RoadStore::open(crowd.file).maintenance.forget(request);
                                  } else {
                                      crowd.drive_beside(february_ms, 5000);
                                  }
                              },
                          .stop = {}};
    EXPECT_EQ(crowd.publish(february_ms, beside).changed, 10U);
    EXPECT_EQ(begun, 2);
    EXPECT_EQ(crowd.seen().front().state->iri_um, 2000);
}

TEST(PublicationBesideOthers, IsMadeHoweverOftenCarsAreForgottenMeanwhile) {
    Crowd crowd;
    crowd.drive_all(12, january_ms);
    int forgotten = 0;
    const Progress beside{.report =
                              [&](std::size_t done, std::size_t) {
                                  constexpr int attempts =
                                      4; // beside others; the next one has the database alone
                                  if (done == 1 && forgotten < attempts) {
                                      ForgetRequest request;
                                      request.vehicles = {"car " + std::to_string(forgotten++)};
                                      RoadStore::open(crowd.file).maintenance.forget(request);
                                  }
                              },
                          .stop = {}};
    EXPECT_EQ(crowd.publish(february_ms, beside).changed, 10U);
    EXPECT_EQ(forgotten, 4);
    EXPECT_EQ(crowd.store.latest_publication()->trips, 5); // eight
}

TEST(PublicationBesideOthers, IsRefusedWhenAnotherOneOfTheMonthWasQuicker) {
    Crowd crowd;
    crowd.drive_all(6, january_ms);
    EXPECT_THAT(
        refusal_of([&] {
            crowd.publish(
                february_ms, meanwhile([&] {
                    RoadStore::open(crowd.file).maintenance.publish(roads_in_a_row(3), february_ms);
                }));
        }),
        HasSubstr("was already published in 2026-02"));
    EXPECT_EQ(crowd.store.latest_publication()->number, 1);
    EXPECT_EQ(crowd.seen().size(), 10U);
}

TEST(PublicationBesideOthers, LeavesNothingBehindWhenItIsStopped) {
    Crowd crowd;
    crowd.drive_all(6, january_ms);
    std::stop_source source;
    auto progress = meanwhile([&] { source.request_stop(); });
    progress.stop = source.get_token();
    EXPECT_THAT(refusal_of([&] { crowd.publish(february_ms, progress); }),
                HasSubstr("crowd.gpkg: interrupted; the database is unchanged"));
    EXPECT_FALSE(crowd.store.latest_publication());
    EXPECT_EQ(crowd.publish(february_ms).changed, 10U); // by the same connection
    EXPECT_EQ(crowd.seen().size(), 10U);
}

TEST(PublicationBesideOthers, IsStoppedInItsLastChunkToo) {
    Crowd crowd;
    crowd.drive_all(6, january_ms);
    std::stop_source source;
    const Progress progress{.report =
                                [&](std::size_t done, std::size_t all) {
                                    if (done == all) {
                                        source.request_stop();
                                    }
                                },
                            .stop = source.get_token()};
    EXPECT_THAT(refusal_of([&] { crowd.publish(february_ms, progress); }),
                HasSubstr("crowd.gpkg: interrupted; the database is unchanged"));
    EXPECT_FALSE(crowd.store.latest_publication());
}

TEST(Publication, NeedsACrowdAndItsKey) {
    Crowd own{PrivacyProfile::own};
    EXPECT_THAT(refusal_of([&] { own.publish(february_ms); }), HasSubstr("privacy: own"));
}

// ------------------------------------------------------------------------------- own -> crowd

TEST(BecomingACrowd, TakesTheEndsOfTripsOut) {
    Crowd crowd{PrivacyProfile::own};
    crowd.drive_all(6, january_ms);
    ASSERT_EQ(crowd.store.info().passes, 180U);
    const auto made = crowd.store.maintenance.make_crowd();
    EXPECT_EQ(made.trips, 6U);
    EXPECT_EQ(made.passes, 180U); // 600 m: all is within 300 m of an end
    EXPECT_EQ(crowd.store.info().passes, 0U);
    EXPECT_EQ(crowd.store.settings().privacy, PrivacyProfile::crowd);
    EXPECT_EQ(RoadStore::open(crowd.file).info().passes, 0U); // its schema is a crowd's
    EXPECT_THAT(crowd.seen({}, Audience::operator_), IsEmpty());
    Database database{crowd.file, Database::Access::read};
    EXPECT_EQ(database.number("SELECT count(*) FROM trip WHERE t0_utc_ms IS NOT NULL"), 0);
    EXPECT_EQ(database.number("SELECT sum(distance_mm + matched_mm) FROM trip"), 0);
    EXPECT_EQ(database.number("SELECT count(*) FROM state_change WHERE iri_um IS NOT NULL"), 0);
}

TEST(BecomingACrowd, IsForGood) {
    Crowd crowd;
    EXPECT_THAT(refusal_of([&] { crowd.store.maintenance.make_crowd(); }),
                HasSubstr("is already a crowd "
                          "database"));
}

TEST(BecomingACrowd, KeepsOutWhatAnImportOfBeforeBrings) {
    Crowd crowd{PrivacyProfile::own};
    auto importer = RoadStore::open(crowd.file);
    crowd.store.maintenance.make_crowd();
    EXPECT_THAT(refusal_of([&] { add_trip(importer, testing::trip_record(1), {}); }),
                HasSubstr("became a crowd database in the meantime"));
}

} // namespace
} // namespace macadam
