// The queue of trips on a real PostgreSQL server.

#include "storage/jobs/job_queue.hpp"

#include "storage/jobs/announced_logs.hpp"
#include "storage/jobs/job_schema.hpp"
#include "storage/jobs/sent_logs.hpp"
#include "storage/jobs/work_status.hpp"
#include "storage/jobs/worker_register.hpp"
#include "storage/store/rows/known_trips.hpp"
#include "storage/store/server/server_schema.hpp"
#include "support/files/files.hpp"
#include "support/program/postgres_server.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <functional>
#include <future>
#include <map>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace macadam {
namespace {

using namespace std::chrono_literals;
using ::testing::AllOf;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::PostgresServer;
using testing::refusal_of;
using ::testing::SizeIs;

std::vector<Job> logs(int count) {
    std::vector<Job> made;
    for (int i = 0; i < count; ++i) {
        made.push_back(
            {.sha256 = fmt::format("{:064x}", i), .suffix = ".trip.csv", .bytes = 1000 + i});
    }
    return made;
}

std::vector<std::string> hashes(const std::vector<Job>& jobs) {
    std::vector<std::string> found;
    for (const auto& job : jobs) {
        found.push_back(job.sha256);
    }
    std::ranges::sort(found);
    return found;
}

/// Submits logs as who stored them does.
std::vector<Submission>
submit(ServerConnection& server, std::span<const Job> jobs, const std::string& objects = {}) {
    announce_logs(server, jobs, objects);
    return submit_logs(server, jobs, objects);
}

const JobTaker anna{"anna", 60s};
const JobTaker ben{"ben", 60s};

class JobQueue : public ::testing::Test {
protected:
    void SetUp() override {
        static int number = 0;
        database_ = fmt::format("roads{}", ++number);
        address_ = server_.new_database(database_);
        connection_.emplace(address_);
        ServerTransaction one{*connection_};
        create_server_schema(*connection_);
        one.commit();
    }

    ServerConnection& queue() { return *connection_; }

    /// Lets the leases of a worker run out, as time would.
    void kill(const JobTaker& taker) {
        queue().rows("UPDATE macadam.job SET lease_until = now() - interval '1 s'"
                     " WHERE worker = $1 AND state = 'working'",
                     {taker.worker});
    }
    void let_pauses_pass() { queue().run("UPDATE macadam.job SET not_before = now()"); }

    std::string reason_of(const Job& job) {
        return queue()
            .rows("SELECT reason FROM macadam.job WHERE sha256 = $1", {job.sha256})
            .at(0)[0]
            .value_or("NULL");
    }

    /// Hashes of logs(100), to lie in a table in another order than their own.
    static constexpr const char* reversed_hashes =
        "SELECT lpad(to_hex(number), 64, '0') AS sha256 FROM generate_series(99, 0, -1) AS number";

    /// Submits logs(100) while `change` locks them, too: each has some of them, and waits for one
    /// in the middle that a third has, before they go on.
    void expect_no_deadlock(const std::string& table,
                            const std::function<void(ServerConnection&)>& change) {
        queue().run("ANALYZE macadam." + table);
        const auto all = logs(100);
        ServerConnection third{address_}, other{address_}, watch{address_};
        std::optional<ServerTransaction> holding{third};
        third.rows(fmt::format("SELECT FROM macadam.{} WHERE sha256 = $1 FOR UPDATE", table),
                   {all[50].sha256});
        auto changed = std::async(std::launch::async, [&] { change(other); });
        auto submitted = std::async(std::launch::async, [&] { submit_logs(queue(), all); });
        while (watch.number("SELECT count(*) FROM pg_stat_activity WHERE wait_event_type = 'Lock'"
                            " AND datname = current_database()") < 2) {
            std::this_thread::sleep_for(1ms);
        }
        holding.reset();
        EXPECT_NO_THROW(changed.get());
        EXPECT_NO_THROW(submitted.get());
    }

    static PostgresServer& one_server() {
        static PostgresServer server{1700s}; // for all tests of this process
        return server;
    }

    PostgresServer& server_ = one_server();
    std::string database_, address_;
    std::optional<ServerConnection> connection_;
};

TEST_F(JobQueue, TakesEachLogOnce) {
    using enum Submission;
    const auto three = logs(3);
    EXPECT_THAT(submit(queue(), three), ElementsAre(added, added, added));
    EXPECT_THAT(submit(queue(), logs(4)), ElementsAre(known, known, known, added));
    EXPECT_THAT(take_jobs(queue(), anna, 10, false), SizeIs(4));
    EXPECT_THAT(submit(queue(), three), Each(known));
    EXPECT_THAT(take_jobs(queue(), ben, 10, false), IsEmpty());
}

TEST_F(JobQueue, GivesAJobToOneOfManyWhoAskAtOnce) {
    submit(queue(), logs(200));
    std::vector<std::vector<Job>> taken(4);
    {
        std::vector<std::jthread> threads;
        for (auto& mine : taken) {
            threads.emplace_back([this, &mine] {
                ServerConnection own{address_};
                for (std::vector<Job> some; !(some = take_jobs(own, anna, 3, false)).empty();) {
                    mine.insert(mine.end(), some.begin(), some.end());
                }
            });
        }
    }
    std::vector<Job> all;
    for (const auto& mine : taken) {
        all.insert(all.end(), mine.begin(), mine.end());
    }
    EXPECT_EQ(hashes(all), hashes(logs(200)));
}

TEST_F(JobQueue, TakesAJobFromADeadWorkerAndLeavesItsLateEndAlone) {
    submit(queue(), logs(1));
    const auto first = take_jobs(queue(), anna, 10, false);
    ASSERT_THAT(first, SizeIs(1));
    EXPECT_EQ(first[0].attempts, 1);
    EXPECT_THAT(take_jobs(queue(), ben, 10, true), IsEmpty()); // anna lives
    kill(anna);
    const auto second = take_jobs(queue(), ben, 10, false);
    ASSERT_THAT(second, SizeIs(1));
    EXPECT_EQ(second[0].attempts, 2);
    EXPECT_EQ(finish_jobs(queue(), anna, std::vector{JobEnd{.job = first[0]}}), 0U);
    EXPECT_EQ(finish_jobs(queue(), ben, std::vector{JobEnd{.job = second[0], .passes = 7}}), 1U);
    EXPECT_EQ(work_status(queue(), 1).logs.at("imported"), 1);
    EXPECT_EQ(work_status(queue(), 1).passes_in_hour, 7);
}

TEST_F(JobQueue, RenewsTheLeasesOfAWorkerThatLives) {
    submit(queue(), logs(1));
    begin_worker(queue(), {.taker = anna, .results_version = 1}, false);
    take_jobs(queue(), anna, 10, false);
    kill(anna);
    renew_worker(queue(), anna, 5);
    EXPECT_THAT(take_jobs(queue(), ben, 10, true), IsEmpty());
    const auto status = work_status(queue(), 1);
    ASSERT_THAT(status.workers, SizeIs(1));
    EXPECT_EQ(status.workers[0].finished, 5);
    EXPECT_EQ(status.workers[0].working, 1);
    end_worker(queue(), "anna");
    EXPECT_THAT(work_status(queue(), 1).workers, IsEmpty());
}

TEST_F(JobQueue, IsWorkedOutWhileTheSameLogsAreSubmittedAgainAndLeasesRenewed) {
    const auto all = logs(100);
    submit(queue(), all);
    std::jthread submitter{[&](const std::stop_token& stop) {
        for (ServerConnection own{address_}; !stop.stop_requested();) {
            submit(own, all); // a deadlock would end the test
            std::this_thread::sleep_for(5ms);
        }
    }};
    std::jthread heart{[&](const std::stop_token& stop) {
        for (ServerConnection own{address_}; !stop.stop_requested();) {
            renew_worker(own, anna, 0);
            std::this_thread::sleep_for(1ms);
        }
    }};
    std::size_t finished = 0;
    while (finished < all.size()) { // those that are just being submitted are passed over
        std::vector<JobEnd> ends;
        for (const auto& job : take_jobs(queue(), anna, 40, false)) {
            ends.push_back({.job = job});
        }
        std::ranges::reverse(ends);
        finished += finish_jobs(queue(), anna, ends);
    }
    EXPECT_EQ(finished, all.size());
}

TEST_F(JobQueue, ParksAJobAtWhichFiveWorkersEnded) {
    submit(queue(), logs(3));
    EXPECT_THAT(take_jobs(queue(), anna, 10, false), SizeIs(3));
    for (int attempt = 2; attempt <= max_job_attempts; ++attempt) {
        kill(anna);
        std::size_t taken_again = 0;
        while (taken_again < 3) {
            const auto taken = take_jobs(queue(), anna, 10, false);
            ASSERT_THAT(taken, Not(IsEmpty()));
            EXPECT_EQ(taken[0].attempts, attempt);
            taken_again += taken.size();
        }
    }
    kill(anna);
    EXPECT_THAT(take_jobs(queue(), anna, 10, false), IsEmpty());
    const auto status = work_status(queue(), 2);
    EXPECT_EQ(status.logs.at("parked"), 3);
    ASSERT_THAT(status.failed, SizeIs(2));
    EXPECT_EQ(status.failed[0].reason, "its worker ended 5 times at this log");
}

TEST_F(JobQueue, TakesRetriesInBatchesThatShrinkUntilEachIsAlone) {
    constexpr std::size_t count = 40;
    submit(queue(), logs(static_cast<int>(count)));
    EXPECT_THAT(take_jobs(queue(), anna, count, false), SizeIs(count));
    for (const std::size_t batch : {20U, 10U, 5U, 1U}) {
        kill(anna);
        for (std::size_t taken = 0; taken < count; taken += batch) {
            ASSERT_THAT(take_jobs(queue(), anna, count, false), SizeIs(batch)) << taken;
        }
    }
}

TEST_F(JobQueue, EndsJobsOfForgottenTripsWhateverTheyWaitFor) {
    submit(queue(), logs(4));
    const auto taken = take_jobs(queue(), anna, 2, false);
    ASSERT_THAT(taken, SizeIs(2));
    const std::string trip(64, 'a'), other(64, 'b');
    JobEnd archive;
    archive.job = taken[0];
    archive.trips = {trip, other};
    finish_jobs(queue(), anna, {&archive, 1});
    // One is an archive with the trip, one waits and is itself the trip's log.
    const auto waiting = logs(4).back();
    for (const auto& hash : {trip, waiting.sha256}) {
        queue().rows("INSERT INTO macadam.forgotten VALUES ($1)", {forgotten_mark(hash)});
    }
    const auto ended = end_forgotten_jobs(queue());
    EXPECT_EQ(hashes(ended), hashes({taken[0], waiting}));
    const auto to_erase = jobs_to_erase(queue(), 10, ErasedLogs::forgotten);
    EXPECT_EQ(hashes(to_erase), hashes(ended)); // by a worker, if nobody else can
    remove_forgotten_jobs(queue(), ended);
    EXPECT_THAT(jobs_to_erase(queue(), 10, ErasedLogs::forgotten), IsEmpty());
    EXPECT_EQ(queue().number("SELECT count(*) FROM macadam.job"), 2);
    EXPECT_EQ(queue().number("SELECT count(*) FROM macadam.job_trip"), 0);
    EXPECT_THAT(end_forgotten_jobs(queue()), IsEmpty());
}

TEST_F(JobQueue, TriesAFailedJobAgainAfterAPauseAndParksItWithItsReason) {
    submit(queue(), logs(1));
    for (int attempt = 1; attempt <= max_job_attempts; ++attempt) {
        const auto taken = take_jobs(queue(), anna, 10, false);
        ASSERT_THAT(taken, SizeIs(1)) << attempt;
        fail_job(queue(), anna, taken[0], "the object is missing");
        EXPECT_THAT(take_jobs(queue(), anna, 10, true), IsEmpty()) << attempt; // not at once
        let_pauses_pass();
    }
    const auto status = work_status(queue(), 5);
    EXPECT_EQ(status.logs.at("parked"), 1);
    EXPECT_EQ(status.oldest_s, 0);
    EXPECT_EQ(reason_of(logs(1)[0]), "the object is missing");
    EXPECT_THAT(submit(queue(), logs(1)), ElementsAre(Submission::requeued));
    EXPECT_THAT(take_jobs(queue(), anna, 10, false), SizeIs(1));
}

TEST_F(JobQueue, DoesNotCountAttemptsThatWereNotMade) {
    submit(queue(), logs(2));
    const auto taken = take_jobs(queue(), anna, 10, false);
    put_back_jobs(queue(), anna, taken);
    const auto again = take_jobs(queue(), ben, 10, false);
    ASSERT_THAT(again, SizeIs(2)); // both at once: neither was begun
    EXPECT_EQ(again[0].attempts, 1);
}

TEST_F(JobQueue, TakesJobsAfterAPauseThatWasAskedFor) {
    submit(queue(), logs(1));
    put_back_jobs(queue(), anna, take_jobs(queue(), anna, 1, false), 60s);
    EXPECT_THAT(take_jobs(queue(), anna, 1, false), IsEmpty());
    let_pauses_pass();
    EXPECT_EQ(take_jobs(queue(), anna, 1, false).at(0).attempts, 1);
}

TEST_F(JobQueue, TakesBackAllJobsOfAWorkerWhoseConnectionBroke) {
    submit(queue(), logs(3));
    EXPECT_THAT(take_jobs(queue(), anna, 2, false), SizeIs(2));
    EXPECT_THAT(take_jobs(queue(), ben, 1, false), SizeIs(1));
    renew_worker(queue(), anna, 0); // the heartbeat goes on
    EXPECT_THAT(take_jobs(queue(), ben, 10, false), IsEmpty());
    put_back_all(queue(), anna);
    const auto again = take_jobs(queue(), anna, 10, false);
    ASSERT_THAT(again, SizeIs(2)); // ben keeps his
    EXPECT_EQ(again[0].attempts, 1);
}

TEST_F(JobQueue, TakesReasonsThatAreNoText) {
    submit(queue(), logs(1));
    const auto taken = take_jobs(queue(), anna, 1, false);
    ASSERT_THAT(taken, SizeIs(1));
    fail_job(queue(), anna, taken[0], std::string{"caf\xe9 \0 ol\xc3\xa9", 11});
    EXPECT_EQ(reason_of(taken[0]), "caf\xef\xbf\xbd \xef\xbf\xbd ol\xc3\xa9");
}

TEST_F(JobQueue, TellsTroubleOfTheServerFromRefusals) {
    EXPECT_THROW(queue().run("SELECT 1 / 0"), InputError);
    try {
        queue().run("SELECT 1 / 0");
    } catch (const ServerTrouble&) {
        ADD_FAILURE() << "a refusal";
    } catch (const InputError&) {
    }
    ServerConnection{address_}.run(
        "SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE pid <> pg_backend_pid()"
        " AND datname = current_database()");
    EXPECT_THROW(queue().run("SELECT 1"), ServerTrouble);
}

TEST_F(JobQueue, LetsRetriesWaitBehindNewLogsButNotForEver) {
    submit(queue(), logs(1));
    fail_job(queue(), anna, take_jobs(queue(), anna, 1, false).at(0), "busy");
    let_pauses_pass();
    submit(queue(), logs(3));
    EXPECT_THAT(take_jobs(queue(), anna, 1, false).at(0).attempts, 1);
    EXPECT_THAT(take_jobs(queue(), anna, 1, true).at(0).attempts, 2);
}

TEST_F(JobQueue, KnowsWhichObjectsAreNoLongerNeeded) {
    submit(queue(), logs(2));
    const auto taken = take_jobs(queue(), anna, 10, false);
    ASSERT_THAT(taken, SizeIs(2));
    finish_jobs(
        queue(),
        anna,
        std::vector{JobEnd{.job = taken[0]},
                    JobEnd{.job = taken[1], .state = UploadState::refused, .reason = "junk"}});
    const auto done = jobs_to_erase(queue(), 10, ErasedLogs::imported);
    ASSERT_THAT(done, SizeIs(1)); // a refused log is kept for those who ask why
    EXPECT_EQ(done[0].sha256, taken[0].sha256);
    note_erased(queue(), done);
    EXPECT_THAT(jobs_to_erase(queue(), 10, ErasedLogs::imported), IsEmpty());
}

TEST_F(JobQueue, KeepsTheObjectOfALogThatIsSubmittedAgain) {
    submit(queue(), logs(1));
    const auto refuse = [&] {
        const auto taken = take_jobs(queue(), anna, 1, false);
        ASSERT_THAT(taken, SizeIs(1));
        finish_jobs(
            queue(), anna, std::vector{JobEnd{.job = taken[0], .state = UploadState::refused}});
    };
    const auto to_erase = [&] { return jobs_to_erase(queue(), 10, ErasedLogs::worked_out); };
    refuse();
    EXPECT_THAT(to_erase(), SizeIs(1));
    announce_logs(queue(), logs(1)); // the submitter stores it now
    EXPECT_THAT(to_erase(), IsEmpty());
    EXPECT_THAT(submit(queue(), logs(1)), ElementsAre(Submission::requeued));
    refuse();
    EXPECT_THAT(to_erase(), SizeIs(1));

    ServerConnection worker{address_};
    queue().run("SET lock_timeout = '100 ms'");
    {
        ServerTransaction erasing{worker};
        note_erased(worker, jobs_to_erase(worker, 10, ErasedLogs::worked_out));
        EXPECT_THAT(refusal_of([&] { announce_logs(queue(), logs(1)); }),
                    HasSubstr("lock timeout"));
        erasing.commit();
    }
    announce_logs(queue(), logs(1)); // it is stored after it was erased, not before
    EXPECT_THAT(to_erase(), IsEmpty());
}

TEST_F(JobQueue, KnowsWhichLogsWereStoredAndNotSubmittedForADay) {
    const auto later = [&](const char* interval) {
        queue().run(fmt::format("UPDATE macadam.announced_log SET announced_at ="
                                " announced_at - interval '{}'",
                                interval));
    };
    announce_logs(queue(), logs(3));
    submit(queue(), logs(1));
    later("23 hours");
    EXPECT_THAT(end_old_announcements(queue(), 10), IsEmpty());
    announce_logs(queue(), logs(2)); // the second once more; the first is known
    later("2 hours");
    EXPECT_THAT(end_old_announcements(queue(), 10), ElementsAre(logs(3)[2].sha256));
    later("1 day");
    EXPECT_THAT(end_old_announcements(queue(), 10), ElementsAre(logs(2)[1].sha256));
    EXPECT_EQ(queue().number("SELECT count(*) FROM macadam.announced_log"), 0);
}

TEST_F(JobQueue, LetsALogBeStoredAgainOnceItsObjectIsErasedNotBefore) {
    announce_logs(queue(), logs(1));
    queue().run("UPDATE macadam.announced_log SET announced_at = now() - interval '2 days';"
                "SET lock_timeout = '100 ms'");
    ServerConnection worker{address_};
    ServerTransaction erasing{worker};
    EXPECT_THAT(end_old_announcements(worker, 10), SizeIs(1));
    EXPECT_THAT(refusal_of([&] { announce_logs(queue(), logs(1)); }), HasSubstr("lock timeout"));
    erasing.commit();
    announce_logs(queue(), logs(1));
    EXPECT_THAT(end_old_announcements(worker, 10), IsEmpty());
}

TEST_F(JobQueue, QueuesNoLogWhoseObjectWasErasedWhenItsAnnouncementGrewOld) {
    announce_logs(queue(), logs(2));
    queue().rows("UPDATE macadam.announced_log SET announced_at = now() - interval '2 days'"
                 " WHERE sha256 = $1",
                 {logs(1)[0].sha256});
    const auto is_gone =
        AllOf(HasSubstr("a log is not in the object store any more, such as " + logs(1)[0].sha256),
              HasSubstr("nothing was queued: store and submit it again"));
    {
        ServerTransaction interrupted{queue()}; // after the object was erased
        EXPECT_THAT(end_old_announcements(queue(), 10), ElementsAre(logs(1)[0].sha256));
    }
    EXPECT_THAT(refusal_of([&] { submit_logs(queue(), logs(2)); }), is_gone);
    EXPECT_THAT(end_old_announcements(queue(), 10), ElementsAre(logs(1)[0].sha256));
    EXPECT_THAT(refusal_of([&] { submit_logs(queue(), logs(2)); }), is_gone);
    EXPECT_EQ(queue().number("SELECT count(*) FROM macadam.job"), 0);
    EXPECT_THAT(submit(queue(), logs(2)), Each(Submission::added));
    EXPECT_THAT(submit_logs(queue(), logs(2)), Each(Submission::known)); // needs no object
}

TEST_F(JobQueue, QueuesNoRefusedLogAgainWhoseObjectWasErased) {
    submit(queue(), logs(1));
    finish_jobs(queue(),
                anna,
                std::vector{JobEnd{.job = take_jobs(queue(), anna, 1, false).at(0),
                                   .state = UploadState::refused}});
    note_erased(queue(), logs(1));
    EXPECT_THAT(refusal_of([&] { submit_logs(queue(), logs(1)); }),
                HasSubstr("store and submit it again"));
    EXPECT_EQ(states_of_logs(queue(), logs(1)).at(0), UploadState::refused);
    EXPECT_THAT(submit(queue(), logs(1)), ElementsAre(Submission::requeued));
}

TEST_F(JobQueue, TakesLogsWhileSomebodyElseAnnouncesThem) {
    queue().run(fmt::format("INSERT INTO macadam.announced_log (sha256) {}", reversed_hashes));
    expect_no_deadlock("announced_log",
                       [](ServerConnection& server) { announce_logs(server, logs(100)); });
}

TEST_F(JobQueue, TakesLogsWhileSomebodyElseChangesThem) {
    const std::vector<std::pair<std::string, std::function<void(ServerConnection&)>>> changes{
        {"state = 'working', attempts = 1, worker = 'anna'",
         [](ServerConnection& server) { put_back_all(server, anna); }},
        {"state = 'outside', deleting = true", end_deleted_jobs},
        {"state = 'outside'", [](ServerConnection& server) { end_forgotten_jobs(server); }},
        {"state = 'known', reason = 'permanently deleted'",
         [](ServerConnection& server) { remove_forgotten_jobs(server, logs(100)); }}};
    for (const auto& log : logs(100)) {
        queue().rows("INSERT INTO macadam.forgotten VALUES ($1)", {forgotten_mark(log.sha256)});
    }
    for (const auto& [state, change] : changes) {
        queue().run(fmt::format("TRUNCATE macadam.job CASCADE;"
                                " INSERT INTO macadam.job (sha256, suffix, bytes)"
                                " SELECT sha256, '.trip.csv', 1 FROM ({}) AS log;"
                                " UPDATE macadam.job SET {}",
                                reversed_hashes,
                                state));
        announce_logs(queue(), logs(100));
        expect_no_deadlock("job", change);
    }
}

TEST_F(JobQueue, ForgetsLogsThatWereDoneLongAgo) {
    submit(queue(), logs(4));
    const auto taken = take_jobs(queue(), anna, 3, false);
    ASSERT_THAT(taken, SizeIs(3));
    finish_jobs(
        queue(),
        anna,
        std::vector{JobEnd{.job = taken[0]}, JobEnd{.job = taken[1]}, JobEnd{.job = taken[2]}});
    note_erased(queue(), std::span{taken}.first(2));
    remove_old_jobs(queue(), 10);
    EXPECT_EQ(queue().number("SELECT count(*) FROM macadam.job"), 4);
    const auto make_old = [&](const Job& job) {
        queue().rows("UPDATE macadam.job SET finished_at = now() - interval '401 days'"
                     " WHERE sha256 = $1",
                     {job.sha256});
    };
    make_old(taken[0]);
    make_old(taken[2]); // whose object is still there
    remove_old_jobs(queue(), 10);
    EXPECT_EQ(queue().number("SELECT count(*) FROM macadam.job"), 3);
    const auto states = states_of_logs(queue(), taken);
    EXPECT_FALSE(states[0].has_value());
    EXPECT_EQ(states[1], UploadState::imported);
    EXPECT_EQ(submit(queue(), std::span{taken}.first(1)).at(0), Submission::added);
}

TEST_F(JobQueue, KeepsItsStoreWhileAnyLogLiesThere) {
    EXPECT_FALSE(objects_location(queue()).has_value());
    put_objects_location(queue(), "/srv/a");
    put_objects_location(queue(), "/srv/b");
    const auto expect_refusal = [&](const std::string& why) {
        put_objects_location(queue(), "/srv/b/"); // the same
        EXPECT_THAT(refusal_of([&] { put_objects_location(queue(), "/srv/a"); }),
                    HasSubstr("lie in /srv/b, where workers look for all logs: " + why + ";"));
        EXPECT_EQ(objects_location(queue()), "/srv/b");
    };
    announce_logs(queue(), logs(2), "/srv/b");
    expect_refusal("2 not queued so far");
    submit_logs(queue(), logs(2), "/srv/b");
    queue().rows("UPDATE macadam.job SET state = 'parked' WHERE sha256 = $1", {logs(1)[0].sha256});
    expect_refusal("1 parked, 1 queued");
    for (const auto state : all_upload_states) {
        queue().rows("UPDATE macadam.job SET state = $1, has_object = true",
                     {std::string{name_of(state)}});
        expect_refusal(fmt::format("2 {}", name_of(state)));
    }
    queue().run("UPDATE macadam.job SET state = 'imported', has_object = false");
    put_objects_location(queue(), "/srv/a");
    EXPECT_EQ(objects_location(queue()), "/srv/a");
}

TEST_F(JobQueue, KeepsItsStoreWhileAWorkerHasItOpen) {
    put_objects_location(queue(), "/srv/a");
    begin_worker(queue(), {.taker = anna, .results_version = 1}, false);
    EXPECT_THAT(refusal_of([&] { put_objects_location(queue(), "/srv/b"); }),
                HasSubstr("a worker is still at work, and would go on looking for logs in /srv/a"));
    end_worker(queue(), "anna");
    put_objects_location(queue(), "/srv/b");
    EXPECT_EQ(objects_location(queue()), "/srv/b");
}

TEST_F(JobQueue, TakesLogsOfOneOfTwoStoresThatAreSubmittedToAtOnce) {
    constexpr int rounds = 20;
    for (int round = 0; round < rounds; ++round) {
        queue().run("DELETE FROM macadam.job; DELETE FROM macadam.announced_log;"
                    " DELETE FROM macadam.work_setting");
        std::vector<int> is_submitted(2);
        {
            std::vector<std::jthread> threads;
            for (std::size_t i = 0; i < is_submitted.size(); ++i) {
                threads.emplace_back([&, i] {
                    ServerConnection own{address_};
                    const auto store = fmt::format("/srv/{}", i);
                    const auto both = logs(2);
                    try {
                        put_objects_location(own, store);
                        submit(own, std::span{both}.subspan(i, 1), store);
                        is_submitted[i] = 1;
                    } catch (const InputError& error) {
                        EXPECT_THAT(error.what(), HasSubstr("where workers look for all logs"));
                    }
                });
            }
        }
        EXPECT_EQ(is_submitted[0] + is_submitted[1], 1) << round;
        EXPECT_EQ(objects_location(queue()), is_submitted[0] == 1 ? "/srv/0" : "/srv/1") << round;
        EXPECT_EQ(queue().number("SELECT count(*) FROM macadam.job"), 1) << round;
    }
}

TEST_F(JobQueue, TakesLogsOfAStoreThatWasReplacedMeanwhileOnlyThere) {
    put_objects_location(queue(), "/srv/a");
    put_objects_location(queue(), "/srv/b"); // by another program
    EXPECT_THAT(refusal_of([&] { submit(queue(), logs(1), "/srv/a"); }),
                AllOf(HasSubstr("just submitted to /srv/b"), HasSubstr("expected /srv/a")));
    EXPECT_EQ(queue().number("SELECT count(*) FROM macadam.job"), 0);
    EXPECT_THAT(submit(queue(), logs(1), "/srv/b"), ElementsAre(Submission::added));
}

TEST_F(JobQueue, QueuesParkedLogsAgainByTheDatabaseAlone) {
    submit(queue(), logs(2));
    queue().run("UPDATE macadam.job SET attempts = 4");
    for (int i = 0; i < 2; ++i) {
        const auto taken = take_jobs(queue(), anna, 1, true);
        ASSERT_THAT(taken, SizeIs(1));
        if (i == 0) {
            fail_job(queue(), anna, taken[0], "the object is missing");
        } else {
            finish_jobs(
                queue(), anna, std::vector{JobEnd{.job = taken[0], .state = UploadState::refused}});
        }
    }
    EXPECT_EQ(submit_parked_logs(queue()), 1U);
    EXPECT_EQ(submit_parked_logs(queue()), 0U);
    const auto taken = take_jobs(queue(), anna, 10, false);
    ASSERT_THAT(taken, SizeIs(1));
    EXPECT_EQ(taken[0].attempts, 1);
    EXPECT_EQ(reason_of(taken[0]), "");
    EXPECT_EQ(work_status(queue(), 1).logs.at("refused"), 1);
}

TEST_F(JobQueue, CountsLogsByStateHoweverTheyCameToIt) {
    const auto expect_counts = [&](const std::string& when) {
        std::map<std::string, std::int64_t> expected;
        for (const auto state : all_upload_states) {
            expected[std::string{name_of(state)}] = queue().number(
                fmt::format("SELECT count(*) FROM macadam.job WHERE state = '{}'", name_of(state)));
        }
        EXPECT_EQ(work_status(queue(), 1).logs, expected) << when;
    };
    submit(queue(), logs(12));
    expect_counts("submitted");
    const auto taken = take_jobs(queue(), anna, 10, false);
    ASSERT_THAT(taken, SizeIs(10));
    std::vector<JobEnd> ends;
    for (std::size_t i = 0; i < 9; ++i) {
        using enum UploadState;
        constexpr std::array states{imported, known, outside, refused};
        ends.push_back({.job = taken[i], .state = states.at(i % states.size())});
    }
    finish_jobs(queue(), anna, ends);
    expect_counts("finished");
    submit(queue(), logs(12)); // those outside and refused come again
    expect_counts("submitted again");
    queue().run("UPDATE macadam.job SET has_object = false,"
                " finished_at = finished_at - interval '401 days'");
    remove_old_jobs(queue(), 3);
    expect_counts("old ones removed");
    queue().run("DELETE FROM macadam.migration WHERE number > 9");
    upgrade_server_schema(queue());
    expect_counts("upgraded");

    const auto rows = [&] { return queue().number("SELECT count(*) FROM macadam.job_count"); };
    sum_job_counts(queue());
    const auto few = rows();
    queue().run("INSERT INTO macadam.job_count SELECT 'known', 0 FROM generate_series(1, 200)");
    EXPECT_EQ(rows(), few + 200);
    sum_job_counts(queue());
    EXPECT_LE(rows(), 3);
    expect_counts("summed");
}

TEST_F(JobQueue, CountsChunksThatWaitForFusionUpToALimit) {
    const auto mark = [&](std::int64_t from, std::int64_t to) {
        queue().rows("INSERT INTO macadam.chunk_dirty (chunk, trip, since_ms) SELECT chunk, trip, 0"
                     " FROM generate_series($1::bigint, $2::bigint) AS chunk,"
                     " generate_series(1, 2) AS trip",
                     {std::to_string(from), std::to_string(to)});
        return work_status(queue(), 1).chunks_to_fuse;
    };
    EXPECT_EQ(mark(1, 70), 70);
    EXPECT_EQ(mark(71, max_chunks_counted - 1), max_chunks_counted - 1);
    EXPECT_EQ(mark(max_chunks_counted, max_chunks_counted + 5), max_chunks_counted);
}

TEST_F(JobQueue, RefusesWorkersOfOtherResults) {
    begin_worker(queue(), {.taker = anna, .results_version = 1}, false);
    begin_worker(queue(), {.taker = ben, .results_version = 1}, false);
    const WorkerEntry other{.taker = {"carl", 60s}, .results_version = 2};
    EXPECT_THAT(refusal_of([&] { begin_worker(queue(), other, true); }),
                AllOf(HasSubstr("compute results of version 1, this program those of version 2"),
                      HasSubstr("2 are still at work")));
    end_worker(queue(), "anna");
    end_worker(queue(), "ben");
    EXPECT_THAT(refusal_of([&] { begin_worker(queue(), other, false); }),
                HasSubstr("or let this one decide with --take-over"));
    begin_worker(queue(), other, true);
    EXPECT_THAT(
        refusal_of([&] { begin_worker(queue(), {.taker = anna, .results_version = 1}, false); }),
        HasSubstr("one is still at work"));
}

TEST_F(JobQueue, IsForImportersAndOperatorsAlone) {
    ServerConnection boss{server_.address(database_)};
    boss.run("DROP SCHEMA macadam CASCADE");
    {
        ServerTransaction one{boss};
        create_server_schema(boss);
        one.commit();
    }
    boss.run("CREATE ROLE guest LOGIN IN ROLE macadam_reader; CREATE ROLE driver LOGIN IN ROLE"
             " macadam_importer");
    ServerConnection guest{server_.address(database_, "guest")};
    EXPECT_THAT(refusal_of([&] { work_status(guest, 1); }), HasSubstr("permission denied"));
    ServerConnection driver{server_.address(database_, "driver")};
    submit(driver, logs(2));
    begin_worker(driver, {.taker = anna, .results_version = 1}, false);
    EXPECT_THAT(take_jobs(driver, anna, 10, false), SizeIs(2));
}

TEST_F(JobQueue, ComesToADatabaseOfAnEarlierSchemaByUpgrade) {
    queue().run("DROP TABLE macadam.job_trip, macadam.job, macadam.announced_log, "
                "macadam.job_count, macadam.worker,"
                " macadam.work_setting, macadam.chunk_change, macadam.published_state,"
                " macadam.published_until, macadam.published_pending, macadam.published_figure,"
                " macadam.published_event, macadam.publication;"
                " ALTER TABLE macadam.trip DROP COLUMN changed, DROP COLUMN trimmed_mm;"
                " ALTER TABLE macadam.drive ADD FOREIGN KEY (trip) REFERENCES macadam.trip;"
                " ALTER TABLE macadam.chunk_dirty RENAME COLUMN trip TO marks;"
                " ALTER TABLE macadam.chunk_dirty ALTER COLUMN marks SET DEFAULT 1,"
                " DROP CONSTRAINT chunk_dirty_pkey, ADD PRIMARY KEY (chunk);"
                " CREATE INDEX chunk_dirty_since ON macadam.chunk_dirty (since_ms, chunk);"
                " INSERT INTO macadam.chunk_dirty (chunk, since_ms) VALUES (7, 0);"
                " DELETE FROM macadam.migration WHERE number > 1");
    EXPECT_THAT(refusal_of([&] { expect_server_schema(queue()); }),
                AllOf(HasSubstr(fmt::format("its schema is of version 1, expected {}",
                                            server_schema_version)),
                      HasSubstr("macadam upgrade postgresql://")));
    EXPECT_EQ(upgrade_server_schema(queue()), 1);
    EXPECT_EQ(upgrade_server_schema(queue()), server_schema_version);
    expect_server_schema(queue());
    EXPECT_THAT(submit(queue(), logs(1)), SizeIs(1));
    EXPECT_EQ(queue().number("SELECT coalesce(sum(trimmed_mm), 0) FROM macadam.trip"), 0);
    queue().run("INSERT INTO macadam.chunk_dirty (chunk, trip, since_ms) VALUES (7, 3, 0)");
    EXPECT_EQ(queue().number("SELECT count(*) FROM macadam.chunk_dirty WHERE trip IN (0, 3)"), 2);
    EXPECT_EQ(queue().number("SELECT count(*) FROM pg_constraint WHERE contype = 'f'"
                             " AND conrelid = 'macadam.drive'::regclass"),
              0);
}

TEST_F(JobQueue, IsSearchedByItsIndexes) {
    submit(queue(), logs(2000));
    queue().run(
        "UPDATE macadam.job SET state = 'imported', finished_at = now() - interval '1 day',"
        " submitted_at = now() - interval '1 day' WHERE number > 20;"
        " UPDATE macadam.job SET state = 'refused' WHERE number > 1990;"
        " INSERT INTO macadam.chunk_dirty (chunk, trip, since_ms) SELECT chunk, trip, 0 FROM"
        " generate_series(1, 5000) AS chunk, generate_series(1, 4) AS trip;"
        " INSERT INTO macadam.job_trip SELECT sha256, sha256 FROM macadam.job;"
        " INSERT INTO macadam.forgotten SELECT encode(sha256(number::text::bytea), 'hex')"
        " FROM generate_series(1, 3) AS number;"
        " ANALYZE macadam.job, macadam.job_trip, macadam.forgotten, macadam.chunk_dirty");
    const auto expect_plan = [&](const std::string& index, const std::string& query) {
        std::string plan;
        for (const auto& row : queue().rows("EXPLAIN " + query)) {
            plan += row[0].value_or("") + "\n";
        }
        EXPECT_THAT(plan,
                    AllOf(HasSubstr(index),
                          Not(HasSubstr("Seq Scan on job")),
                          Not(HasSubstr("Seq Scan on chunk_dirty"))))
            << plan;
    };
    for (const auto& [begun, index] :
         std::map<std::string, std::string>{{"= 0", "job_new"}, {"> 0", "job_begun"}}) {
        expect_plan(index,
                    fmt::format("SELECT sha256 FROM macadam.job WHERE state IN ('queued',"
                                " 'working') AND attempts {} ORDER BY number LIMIT 20"
                                " FOR UPDATE SKIP LOCKED",
                                begun));
    }
    // As remove_old_jobs() asks.
    expect_plan("job_finished",
                "SELECT sha256 FROM macadam.job WHERE finished_at < now() - interval '400 days'"
                " AND NOT has_object AND state IN ('imported', 'known', 'outside', 'refused')"
                " ORDER BY finished_at LIMIT 20 FOR UPDATE SKIP LOCKED");
    // As work_status() asks.
    expect_plan("job_open",
                "SELECT state, count(*), extract(epoch FROM now() - min(submitted_at))"
                " FROM macadam.job WHERE state IN ('queued', 'working', 'parked', 'refused')"
                " GROUP BY state");
    expect_plan("job_open",
                "SELECT sha256, state, reason, attempts FROM macadam.job"
                " WHERE state IN ('parked', 'refused') ORDER BY state, number DESC LIMIT 20");
    expect_plan("job_submitted",
                "SELECT count(*) FROM macadam.job WHERE submitted_at > now() - interval '1 hour'");
    // As backlog_up_to() asks.
    expect_plan("job_open",
                "SELECT count(*) FROM macadam.job WHERE state IN ('queued', 'working')"
                " AND number <= 1000");
    // As end_forgotten_jobs() asks.
    const auto of_forgotten =
        fmt::format("SELECT sha256 FROM macadam.job WHERE sha256 IN"
                    " (SELECT job FROM macadam.forgotten JOIN macadam.job_trip ON {} = mark"
                    " UNION SELECT sha256 FROM macadam.forgotten JOIN macadam.job ON {} = mark)"
                    " ORDER BY sha256 FOR UPDATE",
                    mark_expression("trip"),
                    mark_expression("sha256"));
    expect_plan("job_mark", of_forgotten);
    expect_plan("job_trip_mark", of_forgotten);
    expect_plan("Index Only Scan using chunk_dirty_pkey",
                "SELECT DISTINCT chunk FROM macadam.chunk_dirty ORDER BY chunk LIMIT 1000");
}

} // namespace
} // namespace macadam
