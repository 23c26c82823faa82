#pragma once

#include "storage/store/reader/store_reader.hpp"

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

namespace macadam {

/// Database with a reader for each worker, and the version of its content.
class ServedStore {
public:
    /// \param readers  number of workers, at least one
    /// \param stop     interrupts reading
    ServedStore(std::filesystem::path file,
                Audience audience,
                std::size_t readers,
                std::stop_token stop);
    ~ServedStore();

    /// Reader of a worker; opened when it is first needed, and again after the file was replaced,
    /// maintained, or made a crowd's.
    /// \param audience  operator_: also what a crowd has not published, if the key is there
    StoreReader& reader(std::size_t worker, Audience audience = Audience::anyone);

    /// Text that changes with the content: of letters and digits, for ETag and URLs. Equal over
    /// restarts once all passes are fused.
    std::string version(Audience audience = Audience::anyone) const;

    /// Text that changes with the trips, published or not.
    std::string trips_version() const;

    /// Called with what anyone may read, and its version, before requests see that version.
    using Prepare = std::function<void(const StoreReader& reader, const std::string& version)>;

    /// Looks for changes, which commits of other programs make; called every second by one thread.
    /// \returns true if the version has changed.
    bool look(const Prepare& prepare = {});

    /// Tells whether only publications may be shown, as of the last look; for the thread that
    /// looks.
    bool shows_published_alone() const { return shows_published_alone_; }

    const std::filesystem::path& file() const { return file_; }

private:
    struct Watch;

    StoreReader open(Audience audience) const;
    struct Versions {
        std::string content, all, trips;
    };
    Versions versions_now();

    std::filesystem::path file_;
    Audience audience_;
    std::stop_token stop_;
    bool shows_published_alone_ = false;
    struct Opened {
        std::optional<StoreReader> reader;
        std::size_t epoch = 0;
    };
    std::vector<Opened> readers_; ///< one for each worker, touched by it alone
    std::vector<Opened> operator_readers_;
    std::atomic<std::size_t> epoch_ = 0; ///< grows as readers are to be opened again
    std::unique_ptr<Watch> watch_;
    mutable std::mutex mutex_; ///< guards those below
    Versions versions_;
};

} // namespace macadam
