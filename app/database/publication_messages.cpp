#include "app/database/publication_messages.hpp"

#include "app/database/lock_wait_messages.hpp"
#include "estimator/common/error.hpp"
#include "storage/text/json.hpp"

#include <fmt/format.h>

namespace macadam {

std::string words_for(const Publication& publication) {
    const auto left_out =
        publication.left_out == 0
            ? std::string{"no driven segment is left out"}
            : fmt::format("left out: up to {} segments ({:.1f} km) driven by too few cars",
                          publication.left_out,
                          publication.left_out_km);
    return fmt::format("publication of {}: {:.1f} km in {}, from at least {} trips of {} cars; {}",
                       publication.month,
                       publication.km,
                       counted(publication.segments, "segment"),
                       publication.trips,
                       publication.vehicles,
                       left_out);
}

void tell_publication(const StoreReader& store, const Console& console) {
    if (!store.shows_published_alone()) {
        return;
    }
    const auto publication = store.latest_publication();
    console.say(publication ? words_for(*publication)
                            : fmt::format("{}: crowd database without a publication; run "
                                          "'macadam publish' first",
                                          store.file().string()));
}

bool can_show_events(const StoreReader& store,
                     const SegmentFilter& filter,
                     const Console& console) {
    if (filter.period && store.shows_published_alone()) {
        console.warn(fmt::format("{}: potholes and other events are left out: a crowd database "
                                 "publishes them without months; omit --since and --until to "
                                 "show them",
                                 store.file().string()));
        return false;
    }
    return true;
}

StoreReader open_for_operator(const std::filesystem::path& file,
                              const Console& console,
                              const ServerNeed& need) {
    auto store = opened_reader(file, console, Audience::operator_, need);
    if (store.settings().privacy == PrivacyProfile::crowd && !store.shows_published_alone()) {
        console.say("for the operator only: this shows more than is published; do not pass it "
                    "on");
    }
    tell_publication(store, console);
    return store;
}

void expect_operator(const StoreReader& store, std::string_view what) {
    if (store.shows_published_alone()) {
        throw InputError{fmt::format("{}: {} in a crowd database are for their operator only, "
                                     "expected the key at {}",
                                     store.file().string(),
                                     what,
                                     store.key_file().string())};
    }
}

std::string json_of(const std::optional<Publication>& publication) {
    if (!publication) {
        return "null";
    }
    JsonObject object;
    object.add("month", publication->month)
        .add("segments", static_cast<std::int64_t>(publication->segments))
        .add("km", JsonNumber{publication->km, 3})
        .add("left_out_segments", static_cast<std::int64_t>(publication->left_out))
        .add("left_out_km", JsonNumber{publication->left_out_km, 1})
        .add("min_trips", std::int64_t{publication->trips})
        .add("min_vehicles", std::int64_t{publication->vehicles});
    return object.text();
}

} // namespace macadam
