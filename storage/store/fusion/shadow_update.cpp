#include "storage/store/fusion/shadow_update.hpp"

#include "estimator/common/error.hpp"
#include "storage/store/fusion/dirty_fusion.hpp"
#include "storage/store/fusion/staged_chunks.hpp"
#include "storage/store/fusion/store_version.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <utility>

namespace macadam {
namespace {

constexpr int max_begins = 2; // attempts in shadow tables before it runs under the write lock
constexpr int max_rounds = 5; // to catch up with trips that arrived meanwhile
constexpr std::size_t few_chunks = 20; // fused almost instantly

/// Shows the future database to this connection during its lifetime.
class ShadowTables {
public:
    ShadowTables(Database& database, const Maintenance& maintenance)
        : database_{&database}, maintenance_{&maintenance} {}
    ShadowTables(const ShadowTables&) = delete;
    ShadowTables& operator=(const ShadowTables&) = delete;
    ~ShadowTables() {
        sqlite3_exec(database_->handle(), maintenance_->drop_shadow, nullptr, nullptr, nullptr);
    }

private:
    Database* database_;
    const Maintenance* maintenance_;
};

/// Result computed in shadow tables, with its version.
struct Foreseen {
    StoreVersion moment;
    std::vector<std::int64_t> chunks; ///< chunks whose states the operation changes
};

class Work {
public:
    Work(Database& database,
         std::int64_t segments_per_chunk,
         const ClassTable& classes,
         const Maintenance& maintenance,
         const Progress& progress)
        : database_{&database}, segments_in_chunk_{segments_per_chunk}, classes_{&classes},
          maintenance_{&maintenance}, progress_{&progress}, staged_{database} {}

    bool apply_maintenance() {
        for (int i = 0; i < max_begins; ++i) {
            const auto foreseen = build_shadow();
            if (!foreseen) {
                return false;
            }
            Transaction all{*database_, Transaction::Kind::write};
            if (moment_of(*database_).maintenance == foreseen->moment.maintenance) {
                put_in_place(*foreseen);
                all.commit();
                return true;
            }
        }
        return carry_out_under_the_lock();
    }

private:
    std::optional<Foreseen> build_shadow() {
        const ShadowTables foresight{*database_, *maintenance_};
        auto foreseen = build_shadow_of_all();
        for (int i = 0; foreseen && i < max_rounds && fuse_what_came(*foreseen) > few_chunks; ++i) {
        }
        return foreseen;
    }

    std::optional<Foreseen> build_shadow_of_all() {
        staged_.clear();
        Transaction moment{*database_, Transaction::Kind::read};
        Foreseen foreseen{moment_of(*database_), {}};
        auto chunks = maintenance_->build_shadow();
        if (!chunks) {
            return std::nullopt;
        }
        foreseen.chunks = std::move(*chunks);
        auto wanted = dirty_chunks(*database_);
        wanted.insert(wanted.end(), foreseen.chunks.begin(), foreseen.chunks.end());
        std::ranges::sort(wanted);
        wanted.erase(std::ranges::unique(wanted).begin(), wanted.end());
        fuse(wanted);
        moment.commit();
        return foreseen;
    }

    /// \returns the number of chunks that had to be fused.
    std::size_t fuse_what_came(Foreseen& foreseen) {
        Transaction moment{*database_, Transaction::Kind::read};
        const auto now = moment_of(*database_);
        if (now.maintenance != foreseen.moment.maintenance ||
            now.last_trip == foreseen.moment.last_trip) {
            return 0;
        }
        const auto chunks = chunks_driven_since(*database_, foreseen.moment);
        staged_.remove(chunks);
        fuse(chunks);
        moment.commit();
        foreseen.moment = now;
        return chunks.size();
    }

    void fuse(const std::vector<std::int64_t>& chunks) {
        ChunkFusion states{*database_};
        for (std::size_t i = 0; i < chunks.size(); ++i) {
            expect_to_go_on();
            staged_.put(chunks[i], states.of(chunks[i], segments_in_chunk_));
            (*progress_)(i, chunks.size());
        }
    }

    void put_in_place(const Foreseen& foreseen) {
        const auto came = chunks_driven_since(*database_, foreseen.moment);
        staged_.remove(came);
        const auto audit = maintenance_->apply();
        auto mark = database_->prepare("INSERT OR IGNORE INTO strip_dirty VALUES (?)");
        for (const auto* const chunks : {&foreseen.chunks, &came}) {
            for (const auto chunk : *chunks) {
                mark.run(chunk);
            }
        }
        fuse_dirty_at_once(*database_, {segments_in_chunk_, classes_, audit, &staged_}, *progress_);
    }

    bool carry_out_under_the_lock() {
        staged_.clear();
        Transaction all{*database_, Transaction::Kind::write};
        Foreseen foreseen{moment_of(*database_), {}};
        auto chunks = maintenance_->build_shadow();
        database_->run(maintenance_->drop_shadow);
        if (!chunks) {
            return false;
        }
        foreseen.chunks = std::move(*chunks);
        put_in_place(foreseen);
        all.commit();
        return true;
    }

    void expect_to_go_on() const {
        if (progress_->stop.stop_requested()) {
            throw InputError{fmt::format("{}: interrupted; the database is unchanged",
                                         database_->file().string())};
        }
    }

    Database* database_;
    std::int64_t segments_in_chunk_;
    const ClassTable* classes_;
    const Maintenance* maintenance_;
    const Progress* progress_;
    StagedChunks staged_;
};

} // namespace

bool apply_maintenance(Database& database,
                       std::int64_t segments_per_chunk,
                       const ClassTable& classes,
                       const Maintenance& maintenance,
                       const Progress& progress) {
    return Work{database, segments_per_chunk, classes, maintenance, progress}.apply_maintenance();
}

} // namespace macadam
