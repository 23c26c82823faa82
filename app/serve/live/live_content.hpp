#pragma once

#include "app/cli/console.hpp"
#include "app/export/site_export.hpp"
#include "app/export/site_segments.hpp"
#include "app/serve/live/tile_maker.hpp"
#include "app/serve/live/tile_set.hpp"
#include "storage/atomic/temporary_folder.hpp"
#include "storage/store/reader/store_reader.hpp"
#include "storage/store/records/publication.hpp"
#include "storage/store/records/store_moment.hpp"

#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>

namespace macadam {

/// Web page of one version of a database, with its data.
struct LivePage {
    LivePage(const std::filesystem::path& beside, std::string its_version)
        : folder{beside}, version{std::move(its_version)} {}

    std::filesystem::path place() const { return folder.path() / "site"; }

    TemporaryFolder folder;
    std::string version;
};

/// Content made in the background from a whole version of the database: its tiles, and the web
/// page with its data. Until a newer version is made, the one before is shown. After imports, what
/// did not change is taken from the version before.
class LiveContent {
public:
    /// \param file  the database
    /// \param look  of the page; without a title, it has the name of the file
    LiveContent(std::filesystem::path file,
                Audience audience,
                const Console& console,
                SiteLook look);
    ~LiveContent() = default;
    LiveContent(const LiveContent&) = delete;
    LiveContent& operator=(const LiveContent&) = delete;

    /// Asks for the content of a version. While trips arrive all the time, versions are made at
    /// most for a tenth of the time, and so are those of which all is made. What was made of all
    /// trips is shown no longer once only publications may be.
    void refresh(const std::string& version, bool published_alone);

    /// Latest tiles; null until there are some.
    std::shared_ptr<const TileSet> tiles() const;

    /// Latest page; null until there is one, and in a build without it.
    std::shared_ptr<const LivePage> page() const;

private:
    void work(const std::stop_token& stop);
    bool is_update(const std::stop_token& stop) const;
    void make(const std::string& version, const std::stop_token& stop);
    void
    make_page(const StoreReader& store, const std::string& version, const std::stop_token& stop);

    std::filesystem::path file_;
    Audience audience_;
    const Console& console_;
    SiteLook look_;
    bool has_page_ = true; ///< false once it was refused
    TileMaker tile_maker_; ///< of the thread, as are those below
    std::uint64_t file_number_ = 0;
    struct MadePage {
        std::shared_ptr<const LivePage> page;
        StoreMoment moment;
        SiteSegments segments;
    };
    std::optional<MadePage> made_page_; ///< that the next one builds on
    mutable std::mutex mutex_;          ///< guards the members below
    std::string wanted_;
    bool published_alone_ = false; ///< of the wanted version
    bool was_dropped_ = false;     ///< and is to be made again at once
    std::shared_ptr<const TileSet> tiles_;
    std::shared_ptr<const LivePage> page_;
    std::condition_variable_any asked_;
    std::jthread thread_;
};

} // namespace macadam
