#include "app/serve/trips/upload_place.hpp"

#include "storage/uploads/upload_database.hpp"

#include <utility>

namespace macadam {
namespace {

class FileUploads final : public UploadStore {
public:
    explicit FileUploads(const std::filesystem::path& store)
        : spool_{spool_of(store)}, uploads_{open_uploads(store)} {}

    std::optional<AccessToken> find_token(std::string_view text, std::int64_t now_ms) override {
        return macadam::find_token(uploads_, text, now_ms);
    }
    std::size_t count_waiting() override { return macadam::count_waiting(uploads_); }
    std::string refusal() override { return {}; }
    std::optional<std::string> take_invitation(std::string_view text,
                                               std::int64_t now_ms) override {
        return macadam::take_invitation(uploads_, text, now_ms);
    }
    std::optional<Upload> find_upload(const std::string& sha256) override {
        return macadam::find_upload(uploads_, sha256);
    }
    std::vector<Upload> latest_uploads(const std::string& owner, std::size_t limit) override {
        return macadam::latest_uploads(uploads_, owner, limit);
    }
    bool enqueue(AtomicFile& file, const Upload& upload) override {
        return macadam::enqueue(uploads_, file, upload);
    }
    bool delete_upload(const std::string& sha256) override {
        return macadam::delete_upload(uploads_, spool_, sha256);
    }

private:
    std::filesystem::path spool_;
    Database uploads_;
};

class PlaceBesideFile final : public UploadPlace {
public:
    explicit PlaceBesideFile(std::filesystem::path store) : store_{std::move(store)} {}

    std::unique_ptr<UploadStore> open() override {
        return takes_uploads(store_) ? std::make_unique<FileUploads>(store_) : nullptr;
    }
    std::filesystem::path spool() const override { return spool_of(store_); }

private:
    std::filesystem::path store_;
};

} // namespace

std::unique_ptr<UploadPlace> uploads_beside(const std::filesystem::path& store) {
    return std::make_unique<PlaceBesideFile>(store);
}

} // namespace macadam
