#include "storage/trips/detection/column_names.hpp"

#include "storage/trips/mappings/unit_names.hpp"

#include <algorithm>
#include <cctype>
#include <optional>
#include <vector>

namespace macadam {
namespace {

using Words = std::vector<std::string>;

bool is_upper(char letter) {
    return std::isupper(static_cast<unsigned char>(letter)) != 0;
}

bool is_lower(char letter) {
    return std::islower(static_cast<unsigned char>(letter)) != 0;
}

/// Splits a name at characters other than letters and digits, and where the case says so:
/// "GPSSpeed_kmh" gives gps, speed, kmh.
Words words_in(std::string_view name) {
    Words words;
    std::string word;
    const auto end_word = [&] {
        if (!word.empty()) {
            words.push_back(ascii_lower(word));
        }
        word.clear();
    };
    for (std::size_t i = 0; i < name.size(); ++i) {
        const auto byte = static_cast<unsigned char>(name[i]);
        if (byte < 0x80 && std::isalnum(byte) == 0) {
            end_word();
            continue;
        }
        const bool begins_word =
            is_upper(name[i]) && !word.empty() &&
            (is_lower(word.back()) ||
             (is_upper(word.back()) && i + 1 < name.size() && is_lower(name[i + 1])));
        if (begins_word) {
            end_word();
        }
        word += name[i];
    }
    end_word();
    std::erase(words, "");
    return words;
}

/// Tests whether any of the words is in a list of words between blanks.
bool has_any(const Words& words, std::string_view list) {
    return std::ranges::any_of(words, [&](const std::string& word) {
        return list.find(" " + word + " ") != std::string_view::npos;
    });
}

// clang-format off
constexpr std::string_view acceleration_words = " acc accel acceleration accelerometer accelerations accelero accele gforce acclration beschleunigung beschl aceleracin aceleracion accelerazione acclromtre acceleromtre acm force accelerometeracceleration ";
constexpr std::string_view linear_words = " linear lin user useracceleration linearacceleration linacc lacc ";
constexpr std::string_view gravity_words = " gravity grav schwerkraft ";
constexpr std::string_view rate_words = " gyro gyroscope gyr gyros rotationrate rotrate angularvelocity angular rotation drehrate gyroskop gyroscop girosc gyrorotation omega ";
constexpr std::string_view latitude_words = " lat latitude breite breitengrad lattitude latitud latitudine gpslat gpslatitude ";
constexpr std::string_view longitude_words = " lon long lng longitude lnge lngengrad laenge laengengrad longitud longitudine gpslon gpslong gpslongitude ";
constexpr std::string_view speed_words = " speed velocity geschwindigkeit vitesse velocidad velocit velocita spd velo gpsspeed groundspeed kmh kph kmph mph tempo snelheid ";
constexpr std::string_view course_words = " course heading bearing cog kurs direction richtung cap track hdg ";
constexpr std::string_view accuracy_words = " accuracy hacc precision genauigkeit prcision horizontalaccuracy acuracy ";
constexpr std::string_view time_words = " time timestamp t zeit temps millis micros ms elapsed datetime tiempo sec seconds clock uhrzeit utc epoch unixtime timems tstamp ts utctime gpstime systime heure tijd tempo zeitstempel milliseconds timestampms tow tick ticks ";
constexpr std::string_view date_words = " date datum fecha data gpsdate utcdate ";
constexpr std::string_view receiver_words = " gps gnss location loc sat gpsspeed ground ";
constexpr std::string_view vehicle_words = " obd obd2 obdii wheel ecu can vehicle vss car odo fahrzeug ";
constexpr std::string_view other_words = " altitude height alt elevation mag magnetic magnetometer magneticfield pressure temp temperature humidity light battery rpm throttle distance lean quaternion attitude orientation predicted best lap vs avg average max min limit satellites engine fan wind uncertainty compass azimuth declination activity pedometer delta gap delay split bias uncalibrated hdop vdop pdop climb vertvel rate ";
// clang-format on

/// Axis that a word states, for the quantity of the other words.
NamedAxis axis_in(const Words& words) {
    for (const auto& word : words) {
        if (word.size() == 1 && word.front() >= 'x' && word.front() <= 'z') {
            return {word.front() - 'x' + 1, false};
        }
    }
    for (const auto& word : words) {
        if (has_any({word},
                    " longitudinal long lon inline forward fwd lineal linealg roll rollrate ")) {
            return {1, true};
        }
        if (has_any({word}, " lateral lat lateralg side pitch pitchrate ")) {
            return {2, true};
        }
        if (has_any({word}, " vertical vert verticalg yaw yawrate ")) {
            return {3, true};
        }
    }
    return {};
}

/// Splits the axis off a word: "accx" gives "acc" and x.
bool split_axis(Words& words, std::string_view stems) {
    for (auto& word : words) {
        const char last = word.back();
        if (word.size() > 1 && last >= 'x' && last <= 'z' &&
            has_any({word.substr(0, word.size() - 1)}, stems)) {
            word.pop_back();
            words.emplace_back(1, last);
            return true;
        }
    }
    return false;
}

bool is_one_word_and_axis(const Words& words, std::string_view stem) {
    return words.size() == 2 && words[0] == stem && words[1].size() == 1;
}

/// Splits words such as "accx", "gfx", "latacc" and "wz" into their parts.
Words with_parts(Words words) {
    if (words.size() >= 2 && words[0] == "g" && words[1].size() == 2 && words[1][0] == 'f') {
        words = {"gforce", words[1].substr(1)}; // gFx
    }
    if (words.size() == 1 && has_any(words, " gfx gfy gfz ")) {
        words = {"gforce", words[0].substr(2)};
    }
    for (const std::string_view joined : {"acc", "g", "force", "rate"}) { // latacc, lateralg
        for (auto& word : words) {
            const auto stem = word.substr(0, word.size() - std::min(word.size(), joined.size()));
            if (word.ends_with(joined) && word != "long" &&
                has_any({stem},
                        " lat lon long vert lateral longitudinal vertical inline lineal "
                        "roll pitch yaw rotation ")) {
                word = stem;
                words.emplace_back(joined == "rate" ? "angular" : "acc");
                return words;
            }
        }
    }
    split_axis(words,
               std::string{acceleration_words} +
                   "a g w lin lacc gyr gyro rot rotation rotationrate "
                   "linear gravity linacc accg useracceleration omega gyroscope ");
    return words;
}

Quantity speed_kind(const Words& words) {
    if (has_any(words, vehicle_words)) {
        return Quantity::vehicle_speed;
    }
    return has_any(words, receiver_words) ? Quantity::gnss_speed : Quantity::speed;
}

bool is_acceleration(const Words& words) {
    return has_any(words, acceleration_words) ||
           (words.size() == 2 && words[0] == "a" && axis_in(words).number > 0) ||
           (has_any(words, linear_words) && axis_in(words).number > 0) ||
           (has_any(words, " g ") && axis_in(words).of_vehicle);
}

bool is_rate(const Words& words) {
    return has_any(words, rate_words) || is_one_word_and_axis(words, "w") ||
           is_one_word_and_axis(words, "rot") ||
           (has_any(words, " rate ") && has_any(words, " roll pitch yaw ")) ||
           has_any(words, " rollrate pitchrate yawrate ");
}

/// Quantity of a sensor with three axes.
Quantity triaxial(const Words& words) {
    if (is_rate(words)) {
        return Quantity::angular_rate;
    }
    if (has_any(words, gravity_words)) {
        return Quantity::gravity;
    }
    if (is_acceleration(words)) {
        return has_any(words, linear_words) ? Quantity::linear_acceleration
                                            : Quantity::acceleration;
    }
    return is_one_word_and_axis(words, "g") ? Quantity::angular_rate_or_g : Quantity::unknown;
}

Quantity quantity_of(const Words& words) {
    if (axis_in(words).number > 0) {
        if (const auto quantity = triaxial(words);
            quantity != Quantity::unknown &&
            !has_any(words, " mag magnetic magnetometer orientation quaternion ")) {
            return quantity;
        }
    }
    if (has_any(words, accuracy_words)) {
        return has_any(words,
                       " vertical speed bearing course heading alt altitude v vacc velocity "
                       "accelerometer gyro mag compass dilution coordinate ")
                   ? Quantity::unknown
                   : Quantity::accuracy;
    }
    if (has_any(words, other_words)) {
        return Quantity::unknown;
    }
    if (has_any(words, latitude_words)) {
        return Quantity::latitude;
    }
    if (has_any(words, longitude_words)) {
        return Quantity::longitude;
    }
    const bool is_vector = has_any(words, " x y z north east down vertical vert n e d ve vn vd ");
    const bool is_v = words.size() == 1 && words[0] == "v";
    if ((has_any(words, speed_words) || is_v) && !is_vector &&
        !has_any(words, acceleration_words)) {
        return speed_kind(words);
    }
    if (has_any(words, course_words) && axis_in(words).number == 0 &&
        !has_any(words, " true device name type ")) {
        return Quantity::course;
    }
    if (has_any(words, time_words) && !has_any(words, " zone offset type of ")) {
        return Quantity::time;
    }
    return has_any(words, date_words) ? Quantity::date : Quantity::unknown;
}

std::optional<UnitKind> unit_kind(Quantity quantity) {
    switch (quantity) {
    case Quantity::time:
        return UnitKind::time;
    case Quantity::acceleration:
    case Quantity::linear_acceleration:
    case Quantity::gravity:
        return UnitKind::acceleration;
    case Quantity::angular_rate:
        return UnitKind::angular_rate;
    case Quantity::gnss_speed:
    case Quantity::vehicle_speed:
    case Quantity::speed:
        return UnitKind::speed;
    case Quantity::latitude:
    case Quantity::longitude:
    case Quantity::course:
        return UnitKind::angle;
    case Quantity::accuracy:
        return UnitKind::length;
    default:
        return std::nullopt;
    }
}

/// Texts in round and square brackets of a name, and the name without those that are units.
struct Brackets {
    std::string rest{};
    std::vector<std::string> inside{};
};

Brackets brackets_in(std::string_view name) {
    Brackets found;
    while (!name.empty()) {
        const auto open = name.find_first_of("([");
        const auto close = name.find_first_of(")]", open);
        if (open == std::string_view::npos || close == std::string_view::npos) {
            break;
        }
        found.rest += name.substr(0, open);
        found.rest += ' ';
        const auto text = name.substr(open + 1, close - open - 1);
        if (is_unit_name(text)) {
            found.inside.emplace_back(text);
        } else {
            found.rest += text;
            found.rest += ' ';
        }
        name.remove_prefix(close + 1);
    }
    found.rest += name;
    return found;
}

/// Unit in brackets, in the row of units, or in the last words of the name.
std::string
unit_of(UnitKind kind, const Brackets& name, std::string_view unit, const Words& words) {
    if (const auto named = unit_named(kind, unit)) {
        return std::string{*named};
    }
    for (const auto& text : name.inside) {
        if (const auto named = unit_named(kind, text)) {
            return std::string{*named};
        }
    }
    const auto count = words.size();
    if (count > 2) {
        if (const auto named = unit_named(kind, words[count - 2] + "/" + words[count - 1])) {
            return std::string{*named};
        }
    }
    const bool may_be_name = count > 1 || kind == UnitKind::time || kind == UnitKind::speed;
    const auto named = may_be_name ? unit_named(kind, words.back()) : std::nullopt;
    return named ? std::string{*named} : "";
}

} // namespace

NamedColumn read_column_name(std::string_view name, std::string_view unit) {
    constexpr std::size_t max_length = 200;
    const auto brackets = brackets_in(name.substr(0, max_length));
    const auto original = words_in(brackets.rest);
    const auto words = with_parts(original);
    if (words.empty()) {
        return {};
    }
    NamedColumn column{.quantity = quantity_of(words)};
    if (column.quantity == Quantity::unknown) {
        return column;
    }
    const bool is_triaxial = unit_kind(column.quantity) == UnitKind::acceleration ||
                             unit_kind(column.quantity) == UnitKind::angular_rate ||
                             column.quantity == Quantity::angular_rate_or_g;
    column.axis = is_triaxial ? axis_in(words) : NamedAxis{};
    if (const auto kind = unit_kind(column.quantity)) {
        column.unit = unit_of(*kind, brackets, unit, original);
    }
    for (const auto& word : words) {
        if (axis_in({word}).number == 0) {
            column.family += (column.family.empty() ? "" : " ") + word;
        }
    }
    // SensorLog on iOS, after Core Motion
    column.is_apple = column.family.starts_with("accelerometer acceleration") ||
                      column.family.starts_with("motion user acceleration") ||
                      column.family.starts_with("motion gravity");
    return column;
}

} // namespace macadam
