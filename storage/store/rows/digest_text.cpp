#include "storage/store/rows/digest_text.hpp"

#include <fmt/format.h>

namespace macadam {
namespace {

std::string text_of(const std::optional<std::int64_t>& value) {
    return value ? fmt::format("{}", *value) : "-";
}

std::optional<std::int64_t> whole(const std::optional<IriUm>& um) {
    return um ? std::optional<std::int64_t>{*um} : std::nullopt;
}

std::string text_of(const DigestNumbers& numbers) {
    std::string text;
    for (const auto& number : numbers) {
        text += " " + text_of(number);
    }
    return text + "\n";
}

} // namespace

std::string digest_line_of_pass(bool is_reference,
                                std::string_view segment,
                                std::string_view trip_sha256,
                                const DigestNumbers& numbers) {
    return fmt::format("{} {} {}", is_reference ? "reference" : "pass", segment, trip_sha256) +
           text_of(numbers);
}

DigestNumbers numbers_for_digest(const Pass& pass) {
    return {pass.occurrence,
            whole(pass.iri_left_um),
            whole(pass.iri_right_um),
            whole(pass.iri_centre_um),
            pass.iri_um,
            pass.sd_um,
            pass.centre_only ? 1 : 0,
            pass.validity,
            pass.speed_mmps,
            pass.covered_mm,
            pass.confidence_ppm,
            pass.t_ms};
}

std::string digest_line_of_state(const SegmentState& s) {
    const auto known = [](const std::optional<IriUm>& um) { return text_of(whole(um)); };
    return fmt::format("state {} {} {} {} {} {} {} {:d} {} {} {} {} {} {} {} {} {}\n",
                       name_of(s.segment),
                       s.iri_um,
                       s.sd_um,
                       s.low_um,
                       s.high_um,
                       known(s.left_um),
                       known(s.right_um),
                       s.centre_only,
                       s.validity,
                       s.passes,
                       s.vehicles,
                       text_of(s.first_seen_ms),
                       text_of(s.last_seen_ms),
                       known(s.trend_um_per_year),
                       known(s.trend_sd_um_per_year),
                       text_of(s.change ? std::optional{s.change->utc_ms} : std::nullopt),
                       known(s.change ? std::optional{s.change->um} : std::nullopt));
}

std::string digest_line_of_search(std::string_view trip_sha256) {
    return fmt::format("searched {}\n", trip_sha256);
}

std::string digest_line_of_event(std::string_view segment,
                                 std::string_view trip_sha256,
                                 const DigestNumbers& numbers) {
    return fmt::format("event {} {}", segment, trip_sha256) + text_of(numbers);
}

} // namespace macadam
