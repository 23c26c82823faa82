#include "storage/store/import_store.hpp"

#include "storage/store/connection/import_lock.hpp"

#include <optional>

namespace macadam {
namespace {

class FileImport final : public ImportTarget {
public:
    explicit FileImport(const RoadStore& store) : store_{store} {}

    bool contains_trip(const std::string& sha256) override { return store_.contains_trip(sha256); }

    bool is_trip_of(const std::string& sha256, const std::string& vehicle_id) override {
        return store_.is_trip_of(sha256, vehicle_id);
    }

    std::optional<TripSettings> settings_of_trip(const std::string& sha256) override {
        return store_.settings_of_trip(sha256);
    }

    bool has_forgotten(const std::string& sha256) override { return store_.has_forgotten(sha256); }

    bool make_missing_key() override { return store_.importer.make_missing_key(); }

    const PrivacyKey* key() const override { return store_.key(); }

    std::filesystem::path key_file() const override { return key_file_of(store_.file()); }

    std::vector<bool> add_trips(std::span<const NewTrip> trips) override {
        return store_.importer.add_trips(trips);
    }

    BegunImport begin_import(const std::string& name, std::size_t trips_asked) override {
        // Before the journal: others would find an entry that seems to be that of a killed import.
        lock_.emplace(store_.file(), name);
        BegunImport begun;
        begun.same_runs = lock_->is_other_running(name);
        begun.earlier = store_.importer.begin_import(name, trips_asked);
        begun.other_runs = lock_->is_other_running();
        return begun;
    }

    void end_import(const std::string& name) override {
        store_.importer.end_import(name);
        lock_.reset();
    }

    std::size_t refresh(const Progress& progress, FusionRecord& record, BusyChunks) override {
        return store_.importer.refresh(progress, record);
    }

    std::size_t waiting() override { return store_.waiting(); }

    AlignmentSummary alignment() override { return store_.alignment(); }

private:
    RoadStore store_;
    std::optional<ImportLock> lock_;
};

} // namespace

ImportStore import_store_of(const RoadStore& store) {
    return {store.file(), store, std::make_shared<FileImport>(store)};
}

} // namespace macadam
