#include "storage/trips/mappings/unit_names.hpp"

#include "storage/text/text.hpp"

#include <algorithm>
#include <cctype>
#include <iterator>

namespace macadam {
namespace {

struct UnitWords {
    UnitKind kind;
    std::string_view word;  ///< in mapping files
    std::string_view names; ///< between blanks, without blanks and dots
};

// clang-format off
constexpr UnitWords table[] = {
    {UnitKind::acceleration, "m/s2", " m/s2 m/s^2 m/s/s m/s mps2 ms-2 ms2 m/sec2 m/sec^2 m/s**2 m*s-2 meters/second^2 ms^-2 mss m/ss "},
    {UnitKind::acceleration, "g", " g gs gn g-force gforce "},
    {UnitKind::acceleration, "mg", " mg millig milli-g "},
    {UnitKind::acceleration, "ft/s2", " ft/s2 ft/s^2 ft/s/s fps2 ft/sec2 ft/sec^2 "},
    {UnitKind::angular_rate, "rad/s", " rad/s rad/sec rads radps r/s rads-1 rads^-1 "},
    {UnitKind::angular_rate, "deg/s", " deg/s deg/sec dps degps degs degrees/s degrees/sec degrees/second degree/s /s degs-1 "},
    {UnitKind::speed, "m/s", " m/s mps m/sec ms-1 meters/second metres/second meter/second meters/sec m/second "},
    {UnitKind::speed, "cm/s", " cm/s cmps "},
    {UnitKind::speed, "mm/s", " mm/s mmps "},
    {UnitKind::speed, "km/h", " km/h kmh kph kmph km/hr k/h "},
    {UnitKind::speed, "mph", " mph mi/h mi/hr miles/h miles/hour "},
    {UnitKind::speed, "kn", " kn kt kts knot knots "},
    {UnitKind::time, "s", " s sec secs second seconds sekunden sek "},
    {UnitKind::time, "ms", " ms msec msecs millis millisec milliseconds millisecond "},
    {UnitKind::time, "us", " us usec micros microseconds microsec "},
    {UnitKind::time, "ns", " ns nsec nanos nanoseconds "},
    {UnitKind::angle, "deg", " deg degs degree degrees wgs84 grad d "},
    {UnitKind::length, "m", " m meter meters metre metres mtr "},
    {UnitKind::length, "ft", " ft feet foot "},
};
// clang-format on

constexpr std::string_view other_units =
    " % rpm v volt kpa bar psi c degc km hz ut hpa mi l kg nm sats dop mbar a w no "
    "unixtime mm cm n ";

} // namespace

std::string ascii_lower(std::string_view name) {
    std::string ascii;
    for (const char letter : name) {
        switch (const auto byte = static_cast<unsigned char>(letter)) {
        case 0xB2:
            ascii += '2';
            break;
        case 0xB5:
        case 0xBC:
            ascii += 'u';
            break;
        case 0xB0:
            ascii += "deg";
            break;
        default:
            if (byte < 0x80) {
                ascii += static_cast<char>(std::tolower(byte));
            }
        }
    }
    return ascii;
}

std::optional<std::string_view> unit_named(UnitKind kind, std::string_view name) {
    auto word = ascii_lower(trimmed(name));
    std::erase_if(word, [](char letter) { return letter == ' ' || letter == '.'; });
    if (word.empty()) {
        return std::nullopt;
    }
    word = " " + word + " ";
    const auto* const found = std::ranges::find_if(table, [&](const UnitWords& unit) {
        return unit.kind == kind && unit.names.find(word) != std::string_view::npos;
    });
    return found == std::end(table) ? std::nullopt : std::optional{found->word};
}

bool is_unit_name(std::string_view name) {
    for (const auto kind : {UnitKind::acceleration,
                            UnitKind::angular_rate,
                            UnitKind::speed,
                            UnitKind::time,
                            UnitKind::angle,
                            UnitKind::length}) {
        if (unit_named(kind, name)) {
            return true;
        }
    }
    auto word = ascii_lower(name);
    std::erase(word, ' ');
    return !word.empty() && other_units.find(" " + word + " ") != std::string_view::npos;
}

} // namespace macadam
