#include "storage/store/reader/pass_choice.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>

namespace macadam {
namespace {

std::int64_t row_of_car(Database& database, const std::string& name) {
    auto select = database.prepare("SELECT id FROM vehicle WHERE pseudonym = ?");
    if (!select.bind(name).step()) {
        throw InputError{fmt::format("{}: has no car '{}'", database.file().string(), name)};
    }
    return select.integer(0);
}

} // namespace

bool selects_passes(const SegmentFilter& filter) {
    return filter.period || filter.cars_alone || !filter.vehicle.empty();
}

PassChoice pass_choice(Database& database, const SegmentFilter& filter) {
    PassChoice choice{.period = filter.period, .cars_alone = filter.cars_alone, .vehicle = {}};
    if (!filter.vehicle.empty()) {
        choice.vehicle = row_of_car(database, filter.vehicle);
    }
    return choice;
}

} // namespace macadam
