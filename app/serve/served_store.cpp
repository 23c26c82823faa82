#include "app/serve/served_store.hpp"

#include "app/serve/live/file_number.hpp"
#include "estimator/common/error.hpp"
#include "storage/files/sha256.hpp"
#include "storage/sqlite/sqlite.hpp"
#include "storage/sqlite/sqlite_header_check.hpp"
#include "storage/store/fusion/store_version.hpp"

#include <fmt/format.h>

#include <chrono>
#include <utility>

namespace macadam {
namespace {

std::string hashed(const std::string& text) {
    Sha256 hash;
    hash.add(text);
    constexpr std::size_t letters = 16;
    return hash.hex().substr(0, letters);
}

} // namespace

/// Connection that only looks for changes.
struct ServedStore::Watch {
    explicit Watch(const std::filesystem::path& file)
        : inode{file_number(file)}, database{file, Database::Access::read} {}

    std::uint64_t inode;
    Database database;
    std::int64_t data_version = -1;
    std::int64_t maintenance = -1;
};

ServedStore::ServedStore(std::filesystem::path file,
                         Audience audience,
                         std::size_t readers,
                         std::stop_token stop)
    : file_{std::move(file)}, audience_{audience}, stop_{std::move(stop)}, readers_(readers),
      operator_readers_(readers) {
    static_cast<void>(open(audience_)); // refuses other files at once
    look();
}

ServedStore::~ServedStore() = default;

StoreReader ServedStore::open(Audience audience) const {
    return StoreReader::open(file_, {.stop = stop_}, audience);
}

StoreReader& ServedStore::reader(std::size_t worker, Audience audience) {
    const bool is_of_operator = audience == Audience::operator_;
    auto& [reader, epoch] = (is_of_operator ? operator_readers_ : readers_).at(worker);
    if (const auto now = epoch_.load(); !reader || epoch != now) {
        reader = open(is_of_operator ? audience : audience_);
        epoch = now;
    }
    return *reader;
}

std::string ServedStore::version(Audience audience) const {
    const std::lock_guard lock{mutex_};
    return audience == Audience::operator_ ? versions_.all : versions_.content;
}

std::string ServedStore::trips_version() const {
    const std::lock_guard lock{mutex_};
    return versions_.trips;
}

bool ServedStore::look(const Prepare& prepare) {
    if (const auto inode = file_number(file_); inode == 0) {
        throw InputError{fmt::format("{}: was removed while it was served", file_.string())};
    } else if (!watch_ || watch_->inode != inode) {
        expect_store_file(file_);
        auto watch = std::make_unique<Watch>(file_);
        if (watch_) { // replaced
            ++epoch_;
        }
        watch_ = std::move(watch);
    }
    const auto data_version = watch_->database.number("PRAGMA data_version");
    if (watch_->data_version == data_version) {
        return false;
    }
    // Readers keep the settings, roads and rights that they were opened with. They are opened anew
    // before the version changes, so that no answer of theirs is kept under its name.
    const auto maintenance = moment_of(watch_->database).maintenance;
    if (std::exchange(watch_->maintenance, maintenance) != maintenance) {
        ++epoch_;
    }
    const auto reader = open(audience_);
    const bool shows_published_alone = reader.shows_published_alone();
    if (std::exchange(shows_published_alone_, shows_published_alone) != shows_published_alone) {
        ++epoch_;
    }
    auto versions = versions_now();
    if (prepare) {
        prepare(reader, versions.content);
    }
    watch_->data_version = data_version; // not before, as the above may throw
    const std::lock_guard lock{mutex_};
    std::swap(versions_, versions);
    return versions_.content != versions.content;
}

ServedStore::Versions ServedStore::versions_now() {
    auto& database = watch_->database;
    const Transaction one_moment{database, Transaction::Kind::read};
    const auto published =
        fmt::format("{}\n{}\n{}",
                    watch_->inode,
                    database.number("SELECT coalesce(max(number), 0) FROM publication"),
                    count_of_maps(database));
    const auto [maintenance, last_trip] = moment_of(database);
    auto copied = database.prepare("SELECT value FROM meta WHERE key = ?"); // of a server
    const auto trips = fmt::format("{}\n{}\n{}{}",
                                   watch_->inode,
                                   maintenance,
                                   last_trip,
                                   copied.bind(mirror_moment_key).step() ? copied.text(0) : "");
    auto all = published + "\n" + trips;
    if (!dirty_chunks(database).empty()) { // values change without another trip
        all += fmt::format("\n{}", std::chrono::system_clock::now().time_since_epoch().count());
    }
    Versions versions;
    versions.all = hashed(all);
    versions.trips = hashed("trips\n" + trips);
    // Trips that are not published must not show, either.
    versions.content = shows_published_alone_ ? hashed(published) : versions.all;
    return versions;
}

} // namespace macadam
