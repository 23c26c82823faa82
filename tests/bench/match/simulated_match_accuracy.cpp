// How near matching comes to the truth on simulated drives over real networks: a short form of
// `./run bench match`. It prints what it measured.

#include "off_network.hpp"
#include "simulated_world.hpp"
#include "support/program/places.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

namespace macadam::bench {
namespace {

const std::vector<DrivenNetwork>& world() {
    static const auto driven = [] {
        constexpr std::size_t drives = 4;
        std::vector<DrivenNetwork> networks;
        for (const char* const name : {"harrisburg", "krems", "monaco", "stockholm"}) {
            networks.push_back(driven_network(std::filesystem::path{testing::source_folder()} /
                                                  "sample_data/networks" /
                                                  (std::string{name} + ".osm.pbf"),
                                              drives,
                                              1));
        }
        return networks;
    }();
    return driven;
}

struct Measured {
    double right; ///< share of the length
    double p50_m; ///< of the place along the edge
    double p95_m;
    double outage_p95_m;
    double latency_p95_s;
    double calibration_error;
    double sure; ///< share of the length
    double sure_wrong;
    std::size_t empty;
};

Measured measured(const char* what, const Scenario& scenario) {
    const auto score = score_of(world(), scenario);
    const Measured found{.right = score.right_m / score.length_m,
                         .p50_m = absolute_quantile(score.error_m, 0.5),
                         .p95_m = absolute_quantile(score.error_m, 0.95),
                         .outage_p95_m = absolute_quantile(score.outage_error_m, 0.95),
                         .latency_p95_s = absolute_quantile(score.latency_error_s, 0.95),
                         .calibration_error = calibration_error(score),
                         .sure = score.sure_m / score.length_m,
                         .sure_wrong = score.sure_wrong_m / score.sure_m,
                         .empty = score.empty};
    std::printf(
        "%s: right %.4f, p50 %.2f m, p95 %.2f m, p95 in outages %.2f m, latency p95 %.3f s, "
        "ECE %.3f, sure %.3f, of it wrong %.4f\n",
        what,
        found.right,
        found.p50_m,
        found.p95_m,
        found.outage_p95_m,
        found.latency_p95_s,
        found.calibration_error,
        found.sure,
        found.sure_wrong);
    EXPECT_EQ(found.empty, 0U);
    return found;
}

// The bounds hold what was reached, with a little room.

TEST(SimulatedMatch, WithAllSensorsAndAGoodReceiver) {
    const auto found = measured("all sensors, sigma 3 m", {.sensors = with_all});
    EXPECT_GT(found.right, 0.998);
    EXPECT_LT(found.p50_m, 1);
    EXPECT_LT(found.p95_m, 3);
    EXPECT_LT(found.calibration_error, 0.02);
    EXPECT_GT(found.sure, 0.965);
    EXPECT_LT(found.sure_wrong, 0.003);
}

TEST(SimulatedMatch, WithAllSensorsAndAPoorReceiver) {
    const auto found = measured("all sensors, sigma 10 m", {.sigma_m = 10, .sensors = with_all});
    EXPECT_GT(found.right, 0.99);
}

TEST(SimulatedMatch, OfPositionsAlone) {
    const auto found = measured("positions, sigma 3 m", {});
    EXPECT_GT(found.right, 0.996);
    EXPECT_LT(found.p95_m, 6);
}

TEST(SimulatedMatch, OfPositionsEachFiveSeconds) {
    const auto found = measured("positions, sigma 3 m, each 5 s", {.fix_rate_hz = 0.2});
    EXPECT_GT(found.right, 0.993);
}

TEST(SimulatedMatch, FindsALatencyThatIsNotStated) {
    const auto found = measured("all sensors, sigma 3 m, latency sought",
                                {.sensors = with_all, .latency_stated = false});
    EXPECT_LT(found.latency_p95_s, 0.1);
}

TEST(SimulatedMatch, GoesOnThroughOutagesByOdometerAndGyro) {
    const auto found = measured("all sensors, sigma 3 m, outages of 60 s",
                                {.sensors = with_all, .outages_per_hour = 8});
    EXPECT_LT(found.outage_p95_m, 8);
}

TEST(SimulatedMatch, NoticesRoadsThatTheMapLacks) {
    constexpr double share = 0.05;
    const auto score = off_network_score(world(), {.sensors = with_all}, share, 1);
    std::printf("deleted edges: recall %.3f, precision %.3f\n", score.recall(), score.precision());
    EXPECT_GT(score.recall(), 0.8);
    EXPECT_GT(score.precision(), 0.91);
}

} // namespace
} // namespace macadam::bench
