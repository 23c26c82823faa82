#include "app/serve/live/live_content.hpp"

#include "app/serve/live/file_number.hpp"
#include "app/site/site_page.hpp"
#include "estimator/common/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

namespace macadam {
namespace {

using Clock = std::chrono::steady_clock;

/// End and duration of the making of a version.
struct Made {
    Clock::time_point end{};
    Clock::duration took{};
};

/// Name in the system's folder for temporary files: the database's folder may be read-only.
std::filesystem::path beside() {
    return std::filesystem::temp_directory_path() / "macadam-serve";
}

} // namespace

LiveContent::LiveContent(std::filesystem::path file,
                         Audience audience,
                         const Console& console,
                         SiteLook look)
    : file_{std::move(file)}, audience_{audience}, console_{console}, look_{std::move(look)},
      tile_maker_{beside()}, thread_{[this](const std::stop_token& stop) { work(stop); }} {}

void LiveContent::refresh(const std::string& version, bool published_alone) {
    {
        const std::lock_guard lock{mutex_};
        wanted_ = version;
        if (published_alone && !published_alone_) {
            tiles_.reset();
            page_.reset();
            was_dropped_ = true;
        }
        published_alone_ = published_alone;
    }
    asked_.notify_all();
}

std::shared_ptr<const TileSet> LiveContent::tiles() const {
    const std::lock_guard lock{mutex_};
    return tiles_;
}

std::shared_ptr<const LivePage> LiveContent::page() const {
    const std::lock_guard lock{mutex_};
    return page_;
}

void LiveContent::work(const std::stop_token& stop) {
    remove_old_leftovers_of(beside()); // of a server that was killed
    std::string made;
    Made whole, update; // the last of each kind
    while (true) {
        std::unique_lock lock{mutex_};
        if (!asked_.wait(lock, stop, [&] { return wanted_ != made; }) || stop.stop_requested()) {
            return;
        }
        lock.unlock();
        auto& last = is_update(stop) ? update : whole;
        lock.lock();
        constexpr int rests = 9; // times as long as it worked
        asked_.wait_until(lock, stop, last.end + rests * last.took, [&] { return was_dropped_; });
        if (stop.stop_requested()) {
            return;
        }
        made = wanted_;
        was_dropped_ = false;
        lock.unlock();
        const auto begin = Clock::now();
        Clock::duration least{};
        try {
            make(made, stop);
        } catch (const std::exception& error) {
            if (!stop.stop_requested()) {
                console_.warn(fmt::format("the tiles could not be made: {}", error.what()));
            }
            made.clear(); // once more, though nothing changes: the disk may have been full
            least = std::chrono::seconds{60} / rests;
        }
        last.end = Clock::now();
        last.took = std::max(last.end - begin, least);
    }
}

/// Tests whether the next version will be made from the one before.
bool LiveContent::is_update(const std::stop_token& stop) const {
    try {
        return file_number(file_) == file_number_ &&
               tile_maker_.can_update(StoreReader::open(file_, {.stop = stop}, audience_));
    } catch (const InputError&) { // it is told when the version is made
        return false;
    }
}

void LiveContent::make(const std::string& version, const std::stop_token& stop) {
    const auto store = StoreReader::open(file_, {.stop = stop}, audience_);
    const Progress progress{{}, stop};
    if (const auto number = file_number(file_); file_number_ != number) {
        store.expect_in_place();
        tile_maker_.forget();
        made_page_.reset();
        file_number_ = number;
    }
    const auto begin = Clock::now();
    auto tiles = tile_maker_.make(store, version, progress);
    console_.detail(fmt::format("{} of {} tiles made in {:.1f} s",
                                tile_maker_.made(),
                                tiles->count(),
                                std::chrono::duration<double>{Clock::now() - begin}.count()));
    {
        const std::lock_guard lock{mutex_};
        if (was_dropped_) { // the store that was read may not be shown any longer
            return;
        }
        tiles_ = tiles;
        if (tiles->count() == 0) { // what the page shows was deleted, or is to be published first
            page_.reset();
        }
    }
    if (tiles->count() == 0) {
        made_page_.reset();
    }
    if (!has_page_ || tiles->count() == 0) {
        return;
    }
    try {
        static_cast<void>(site_page_folder());
    } catch (const InputError& no_page) {
        has_page_ = false;
        console_.say(no_page.what());
        return;
    }
    const auto begin_of_page = Clock::now();
    make_page(store, version, stop);
    console_.detail(
        fmt::format("the page made in {:.1f} s",
                    std::chrono::duration<double>{Clock::now() - begin_of_page}.count()));
}

void LiveContent::make_page(const StoreReader& store,
                            const std::string& version,
                            const std::stop_token& stop) {
    const auto before = std::exchange(made_page_, std::nullopt);
    auto moment = store.moment(); // what is committed from now on is made again the next time
    std::optional<EarlierSite> earlier;
    if (auto changed = before ? store.changed_since(before->moment) : std::nullopt) {
        EarlierSite site{before->page->place(), before->segments, *std::move(changed)};
        earlier = std::move(site);
    }
    auto look = look_;
    if (look.title.empty()) {
        look.title = file_.stem().string();
    }
    auto page = std::make_shared<const LivePage>(beside(), version);
    auto segments =
        export_site(store,
                    {},
                    page->place(),
                    {.look = std::move(look),
                     .tiles = {.min_zoom = TileSet::min_zoom, .max_zoom = TileSet::max_zoom},
                     .served_version = version,
                     .earlier = earlier ? &*earlier : nullptr},
                    Console{Verbosity::quiet, stop});
    MadePage made{page, std::move(moment), std::move(segments)};
    made_page_ = std::move(made);
    const std::lock_guard lock{mutex_};
    if (!was_dropped_) {
        page_ = std::move(page);
    }
}

} // namespace macadam
