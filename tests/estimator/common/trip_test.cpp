#include "estimator/common/trip.hpp"

#include <gmock/gmock.h>

namespace macadam::testing {
namespace {

TEST(Account, CountsEveryRowOnceWithItsFirstReason) {
    TripLog trip;
    trip.rows = {row_content::acc,
                 row_content::acc | row_content::fix,
                 row_content::speed,
                 code(RowReason::bad_number),
                 row_content::acc | row_content::gyro,
                 row_content::fix};
    const RowAudit use{.acc = {0, code(RowReason::too_slow), code(RowReason::no_speed)},
                       .gyro = {code(RowReason::unused_channel)},
                       .speed = {code(RowReason::implausible)},
                       .fixes = {0, code(RowReason::inaccurate)}};
    const RowCount expected{
        .read = 6,
        .used = 2,
        .rejected = 4,
        .reasons = {{"bad_number", 1}, {"implausible", 1}, {"inaccurate", 1}, {"no_speed", 1}}};
    const auto count = account(trip, use);
    EXPECT_EQ(count, expected);
    EXPECT_EQ(count.read, count.used + count.rejected);
}

TEST(Account, UsesARowOfWhichOneSampleServed) {
    TripLog trip;
    trip.rows = {row_content::acc | row_content::speed};
    const RowAudit use{.acc = {code(RowReason::too_slow)}, .gyro = {}, .speed = {0}, .fixes = {}};
    EXPECT_EQ(account(trip, use).used, 1);
}

} // namespace
} // namespace macadam::testing
