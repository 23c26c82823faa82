#include "support/program/piped_program.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <cstdio>

namespace macadam::testing {
namespace {

/// Peak memory of a trip of so many minutes at 50 Hz and 20 m/s, MB.
double peak_mb(int minutes) {
    constexpr int rate_hz = 50;
    PipedProgram program{{"trace", "--live", "--method", "kf", "--length", "1000"}};
    program.write("# macadam-trip 1\n# vehicle_id: golden-car\n# frame: FLU\n# gravity: included\n"
                  "t_s,acc_z_mps2,speed_mps,lat_deg,lon_deg\n");
    for (int minute = 0; minute < minutes; ++minute) {
        std::string text;
        for (int i = minute * 60 * rate_hz; i < (minute + 1) * 60 * rate_hz; ++i) {
            const double t_s = static_cast<double>(i) / rate_hz;
            text += fmt::format(
                "{:.2f},{:.3f},20,,\n", t_s, 9.81 + std::sin(8 * t_s) + std::sin(61 * t_s));
            text += i % rate_hz == 0 ? fmt::format("{:.2f},,,{:.7f},11\n", t_s, 48 + t_s * 2e-4)
                                     : std::string{};
        }
        program.write(text);
        while (program.line(std::chrono::seconds{0})) {
        }
    }
    program.end_input();
    while (program.line(std::chrono::seconds{60})) {
    }
    return program.wait().peak_mb;
}

} // namespace

/// What is kept is full after ten minutes (live_trace.cpp).
TEST(LiveMemory, IsNoMoreForALongerTrip) {
    const double short_mb = peak_mb(12);
    const double long_mb = peak_mb(60);
    std::printf("12 minutes: %.1f MB, 60 minutes: %.1f MB\n", short_mb, long_mb);
    EXPECT_LT(long_mb, short_mb + 2); // 180,000 rows more would be 10 MB
}

} // namespace macadam::testing
