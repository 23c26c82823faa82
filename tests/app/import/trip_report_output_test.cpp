#include "app/import/trip_report_output.hpp"

#include <gmock/gmock.h>

namespace macadam {
namespace {

std::string printed(const TripReport& trip) {
    ::testing::internal::CaptureStdout();
    print_report(trip, false, Console{Verbosity::normal});
    return ::testing::internal::GetCapturedStdout();
}

TEST(TripReportOutput, SaysWhetherATripOutsideTheMapIsInTheDatabase) {
    TripReport trip;
    trip.result = TripReport::Result::outside;
    trip.file = "a.trip.csv";
    EXPECT_EQ(printed(trip), "outside   a.trip.csv: touches no road of this map, not stored\n");
    trip.is_stored = true; // as when it is reprocessed
    EXPECT_EQ(printed(trip),
              "outside   a.trip.csv: touches no road of this map, its earlier passes stay\n");
}

} // namespace
} // namespace macadam
