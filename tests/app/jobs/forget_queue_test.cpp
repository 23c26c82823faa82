// 'forget' on a database on a real server, while logs wait in its queue.

#include "app/jobs/worker_world.hpp"
#include "storage/postgres/server_connection.hpp"
#include "support/program/piped_program.hpp"

#include <gmock/gmock.h>

#include <chrono>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace macadam::testing {
namespace {

using namespace std::chrono_literals;
using ::testing::AllOf;
using ::testing::HasSubstr;

/// A trip is in the database, and a log waits.
class ForgetOnAServer : public ::testing::Test {
protected:
    void SetUp() override {
        for (const std::size_t trips : {1U, 2U}) {
            world_.make_trips(trips);
            ASSERT_EQ(run_macadam(world_.submit_words()).exit_status, 0);
            if (trips == 1) {
                ASSERT_EQ(run_macadam(world_.worker_words()).exit_status, 0);
            }
        }
        server_.emplace(world_.address);
        words_ = {"forget",
                  world_.address,
                  "--trip",
                  server_->rows("SELECT sha256 FROM macadam.trip").at(0)[0].value_or("")};
    }

    void let_a_worker_live(const std::string& lease_s) {
        server_->rows("INSERT INTO macadam.worker (name, results_version, jobs, seen_at, lease_s)"
                      " VALUES ('anna', 1, 1, now() + interval '1 hour', $1)",
                      {lease_s});
    }

    /// Submits a log that never comes to its turn, once `forget` looked what waits.
    void submit_later() {
        const auto end = std::chrono::steady_clock::now() + 60s;
        while (server_->number("SELECT count(*) FROM pg_stat_activity"
                               " WHERE datname = current_database() AND pid <> pg_backend_pid()"
                               " AND query LIKE '%number <= $1%'") == 0) {
            ASSERT_LT(std::chrono::steady_clock::now(), end);
            std::this_thread::sleep_for(10ms);
        }
        server_->run("INSERT INTO macadam.job (sha256, suffix, bytes, not_before)"
                     " VALUES (repeat('f', 64), '.trip.csv', 1, now() + interval '1 day')");
    }

    void expect_forgotten(const PipedProgram::End& forgot, int trips_left) {
        EXPECT_EQ(forgot.exit_status, 0) << forgot.err;
        EXPECT_THAT(forgot.err, HasSubstr("wait in the queue, first (1 log)"));
        EXPECT_EQ(server_->number("SELECT count(*) FROM macadam.trip"), trips_left);
        EXPECT_EQ(server_->number("SELECT count(*) FROM macadam.job WHERE state = 'queued'"), 1);
    }

    WorkerWorld world_;
    std::optional<ServerConnection> server_;
    std::vector<std::string> words_;
};

TEST_F(ForgetOnAServer, ImportsWhatWasSubmittedBeforeAndNotWhatComesLater) {
    PipedProgram forget{words_};
    submit_later();
    expect_forgotten(forget.wait(), 1);
}

TEST_F(ForgetOnAServer, WaitsForWorkersUntilTheyImportedWhatWasSubmittedBefore) {
    let_a_worker_live("60");
    PipedProgram forget{words_};
    submit_later();
    server_->run("UPDATE macadam.job SET state = 'outside', finished_at = now()"
                 " WHERE state = 'queued' AND not_before <= now()");
    expect_forgotten(forget.wait(), 0);
}

TEST_F(ForgetOnAServer, EndsWithWordsWhereWorkersImportNothing) {
    let_a_worker_live("1");
    const auto forgot = run_macadam(words_);
    EXPECT_EQ(forgot.exit_status, 1);
    EXPECT_THAT(forgot.err,
                AllOf(HasSubstr("a log waits in the queue, and no worker imported any for 2 s"),
                      HasSubstr("nothing was changed")));
    EXPECT_EQ(server_->number("SELECT count(*) FROM macadam.trip"), 1);
}

} // namespace
} // namespace macadam::testing
