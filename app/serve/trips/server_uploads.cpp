#include "app/serve/trips/server_uploads.hpp"

#include "app/jobs/job_options.hpp"
#include "app/serve/trips/token_watch.hpp"
#include "estimator/common/error.hpp"
#include "storage/jobs/announced_logs.hpp"
#include "storage/jobs/sent_logs.hpp"
#include "storage/jobs/server_tokens.hpp"
#include "storage/objects/object_store.hpp"
#include "storage/store/server/user_files.hpp"

#include <fmt/format.h>

#include <system_error>
#include <utility>

namespace macadam {
namespace {

namespace fs = std::filesystem;

class ServerUploads final : public UploadStore {
public:
    ServerUploads(std::string address, fs::path spool, TokenWatch& tokens)
        : address_{std::move(address)}, spool_{std::move(spool)}, tokens_{tokens} {}

    std::optional<AccessToken> find_token(std::string_view text, std::int64_t now_ms) override {
        return tokens_.find(text, now_ms);
    }

    std::size_t count_waiting() override { return tokens_.waiting(); }

    std::string refusal() override {
        return tokens_.objects() ? ""
                                 : "this database has no object store so far: its operator names "
                                   "one with 'macadam submit --objects'";
    }

    std::optional<std::string> take_invitation(std::string_view text,
                                               std::int64_t now_ms) override {
        auto token = macadam::take_invitation(server(), text, now_ms);
        if (token) {
            tokens_.look(server()); // who has it uses it at once
        }
        return token;
    }

    std::optional<Upload> find_upload(const std::string& sha256) override {
        return find_sent_log(server(), sha256);
    }

    std::vector<Upload> latest_uploads(const std::string& owner, std::size_t limit) override {
        return latest_sent_logs(server(), owner, limit);
    }

    bool enqueue(AtomicFile& file, const Upload& upload) override {
        if (const auto known = find_sent_log(server(), upload.sha256);
            known &&
            (!is_tried_again(known->state) || known->owner != upload.owner || known->deleting)) {
            confirm_log(server(), upload.sha256);
            return false;
        }
        const Job job{.sha256 = upload.sha256, .suffix = upload.suffix, .bytes = upload.bytes};
        const auto spooled = upload.file_in(spool_);
        file.commit();
        try {
            auto& objects = opened_objects();
            announce_logs(server(), {&job, 1}, location_);
            objects.put({job.sha256, job.bytes}, spooled);
            submit_logs(server(), {&job, 1}, location_, upload.owner);
        } catch (...) {
            objects_.reset(); // it may be another one now
            remove_file(spooled);
            throw;
        }
        remove_file(spooled);
        return true;
    }

    bool delete_upload(const std::string& sha256) override {
        const auto job = delete_log(server(), sha256);
        if (!job) {
            return !find_sent_log(server(), sha256);
        }
        try {
            opened_objects().remove(sha256);
            remove_forgotten_jobs(server(), {&*job, 1});
            return true;
        } catch (const InputError&) { // a worker erases it
            objects_.reset();
            return false;
        }
    }

private:
    static void remove_file(const fs::path& file) {
        std::error_code ignored; // the folder goes with the server
        fs::remove(file, ignored);
    }

    ServerConnection& server() {
        if (!server_) {
            server_.emplace(opened_server(address_));
        }
        return *server_;
    }

    ObjectStore& opened_objects() {
        const auto location = tokens_.objects();
        if (!location) {
            throw InputError{refusal()};
        }
        if (!objects_ || location_ != *location) {
            location_ = *location;
            objects_ = open_object_store(location_, {}, MissingFolder::refuse);
        }
        objects_->expect_in_place();
        return *objects_;
    }

    std::string address_;
    fs::path spool_;
    TokenWatch& tokens_;
    std::optional<ServerConnection> server_;
    std::string location_;
    std::unique_ptr<ObjectStore> objects_;
};

fs::path swept_spool_name() {
    auto name = mirror_folder().parent_path() / "uploads";
    fs::create_directories(name.parent_path());
    remove_old_leftovers_of(name);
    return name;
}

class PlaceOnServer final : public UploadPlace {
public:
    PlaceOnServer(const std::string& address, bool is_open)
        : address_{address}, is_open_{is_open}, spool_{swept_spool_name()}, tokens_{address} {}

    std::unique_ptr<UploadStore> open() override {
        return is_open_ || tokens_.has_any()
                   ? std::make_unique<ServerUploads>(address_, spool_.path(), tokens_)
                   : nullptr;
    }
    fs::path spool() const override { return spool_.path(); }

private:
    std::string address_;
    bool is_open_;
    TemporaryFolder spool_;
    TokenWatch tokens_;
};

} // namespace

std::unique_ptr<UploadPlace> uploads_on_server(const std::string& address, bool is_open) {
    auto server = opened_server(address);
    return may_read_tokens(server) ? std::make_unique<PlaceOnServer>(address, is_open) : nullptr;
}

} // namespace macadam
