// Tokens and sent logs of a database on a real PostgreSQL server.

#include "storage/jobs/sent_logs.hpp"

#include "storage/jobs/announced_logs.hpp"
#include "storage/jobs/server_tokens.hpp"
#include "storage/store/server/server_schema.hpp"
#include "support/files/files.hpp"
#include "support/program/postgres_server.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <optional>
#include <string>
#include <vector>

namespace macadam {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::PostgresServer;
using testing::refusal_of;
using ::testing::SizeIs;

const JobTaker worker{"worker", 60s};

class SentLogs : public ::testing::Test {
protected:
    void SetUp() override {
        static int number = 0;
        database_ = fmt::format("sent{}", ++number);
        connection_.emplace(server_.new_database(database_));
        ServerTransaction one{*connection_};
        create_server_schema(*connection_);
        connection_->run("DROP TABLE macadam.trip CASCADE;" // of which only the hash is asked for
                         " CREATE TABLE macadam.trip (sha256 text PRIMARY KEY)");
        one.commit();
    }

    ServerConnection& queue() { return *connection_; }

    static Job log(char digit) {
        return {.sha256 = std::string(64, digit), .suffix = ".trip.csv", .bytes = 7};
    }
    static std::string trip(char digit) { return std::string(64, digit); }

    void send(const Job& log, const std::string& owner) {
        announce_logs(queue(), std::vector{log});
        submit_logs(queue(), std::vector{log}, {}, owner);
    }

    /// Lets a worker import the only log that waits. \param own  trips that were not known
    void import(const std::vector<std::string>& trips, const std::vector<std::string>& own) {
        const auto taken = take_jobs(queue(), worker, 1, false);
        ASSERT_THAT(taken, SizeIs(1));
        for (const auto& each : own) {
            queue().rows("INSERT INTO macadam.trip VALUES ($1)", {each});
        }
        finish_jobs(
            queue(), worker, std::vector{JobEnd{.job = taken[0], .trips = trips, .own = own}});
    }

    static PostgresServer& one_server() {
        static PostgresServer server{1700s}; // for all tests of this process
        return server;
    }

    PostgresServer& server_ = one_server();
    std::string database_;
    std::optional<ServerConnection> connection_;
};

TEST_F(SentLogs, BelongToWhoSentThemFirst) {
    send(log('a'), "anna");
    send(log('b'), "");
    send(log('a'), "ben");
    const auto sent = find_sent_log(queue(), log('a').sha256);
    ASSERT_TRUE(sent);
    EXPECT_EQ(sent->owner, "anna");
    EXPECT_EQ(sent->state, UploadState::queued);
    EXPECT_EQ(sent->bytes, 7);
    EXPECT_THAT(latest_sent_logs(queue(), "anna", 10), SizeIs(1));
    EXPECT_THAT(latest_sent_logs(queue(), "ben", 10), IsEmpty());
    EXPECT_THAT(latest_sent_logs(queue(), "", 10), SizeIs(2));
    EXPECT_EQ(count_waiting_logs(queue(), 10), 2U);
    EXPECT_EQ(count_waiting_logs(queue(), 1), 1U);
}

TEST_F(SentLogs, AreDeletedAtOnceBeforeAWorkerHasBegunThem) {
    send(log('a'), "anna");
    const auto job = delete_log(queue(), log('a').sha256);
    ASSERT_TRUE(job);
    EXPECT_TRUE(find_sent_log(queue(), log('a').sha256)->deleting); // until its object is erased
    EXPECT_THAT(take_jobs(queue(), worker, 1, false), IsEmpty());
    EXPECT_THAT(jobs_to_erase(queue(), 10, ErasedLogs::forgotten), SizeIs(1));
    remove_forgotten_jobs(queue(), std::vector{*job});
    EXPECT_FALSE(find_sent_log(queue(), log('a').sha256));
    EXPECT_FALSE(delete_log(queue(), log('a').sha256));
}

TEST_F(SentLogs, ThatAWorkerHasBegunAreDeletedOnceTheyAreWorkedOut) {
    send(log('a'), "anna");
    put_back_jobs(queue(), worker, take_jobs(queue(), worker, 1, false));
    EXPECT_FALSE(delete_log(queue(), log('a').sha256)); // its trips may be in the database
    EXPECT_FALSE(has_deletions(queue()));
    import({trip('1'), trip('1')}, {trip('1')});
    EXPECT_TRUE(has_deletions(queue()));
    EXPECT_THAT(trips_to_delete(queue(), 10), ElementsAre(trip('1')));
    end_deleted_jobs(queue());
    EXPECT_EQ(find_sent_log(queue(), log('a').sha256)->state, UploadState::imported);
    queue().run("DELETE FROM macadam.trip"); // forgotten
    end_deleted_jobs(queue());
    EXPECT_FALSE(has_deletions(queue()));
    EXPECT_THAT(jobs_to_erase(queue(), 10, ErasedLogs::forgotten), SizeIs(1));
}

TEST_F(SentLogs, TakeAlongNoTripThatAnotherLogBrought) {
    send(log('a'), "anna");
    import({trip('1')}, {trip('1')});
    send(log('b'), "ben");
    import({trip('1')}, {}); // known
    EXPECT_TRUE(delete_log(queue(), log('b').sha256));
    EXPECT_THAT(trips_to_delete(queue(), 10), IsEmpty());

    send(log('c'), "ben");
    put_back_jobs(queue(), worker, take_jobs(queue(), worker, 1, false));
    const auto taken = take_jobs(queue(), worker, 1, false);
    ASSERT_THAT(taken, SizeIs(1));
    EXPECT_TRUE(taken[0].was_begun); // so that a known trip counts as its own
    finish_jobs(queue(),
                worker,
                std::vector{JobEnd{.job = taken[0], .trips = {trip('1')}, .own = {trip('1')}}});
    EXPECT_TRUE(delete_log(queue(), log('c').sha256));
    EXPECT_THAT(trips_to_delete(queue(), 10), IsEmpty());
    EXPECT_FALSE(delete_log(queue(), log('a').sha256));
    EXPECT_THAT(trips_to_delete(queue(), 10), ElementsAre(trip('1')));
}

TEST_F(SentLogs, TellNothingOfTheOperatorsMachines) {
    send(log('a'), "anna");
    for (int attempt = 0; attempt < max_job_attempts; ++attempt) {
        queue().run("UPDATE macadam.job SET not_before = now()");
        const auto taken = take_jobs(queue(), worker, 1, false);
        ASSERT_THAT(taken, SizeIs(1));
        fail_job(queue(), worker, taken[0], "/srv/logs: is no folder here");
        EXPECT_THAT(find_sent_log(queue(), log('a').sha256)->reason, Not(HasSubstr("/srv")));
    }
    EXPECT_EQ(find_sent_log(queue(), log('a').sha256)->state, UploadState::refused);
    EXPECT_EQ(states_of_logs(queue(), std::vector{log('a')}).at(0), UploadState::parked);
}

TEST_F(SentLogs, StayKnownToWhoMayDeleteThem) {
    send(log('a'), "anna");
    import({trip('1')}, {trip('1')});
    send(log('b'), "");
    import({trip('2')}, {trip('2')});
    queue().run("UPDATE macadam.job SET has_object = false,"
                " finished_at = now() - interval '500 days'");
    remove_old_jobs(queue(), 10);
    EXPECT_TRUE(find_sent_log(queue(), log('a').sha256));
    EXPECT_FALSE(find_sent_log(queue(), log('b').sha256));
}

AccessToken of(const std::string& owner, TokenScope scope = TokenScope::upload) {
    return {.id = {}, .owner = owner, .scope = scope, .created_ms = 1, .expires_ms = 1000};
}

using ServerTokens = SentLogs;

TEST_F(ServerTokens, AreKeptByTheHashOfTheirSecretAlone) {
    const auto before = version_of_tokens(queue());
    const auto text = create_token(queue(), of("anna"));
    EXPECT_GT(version_of_tokens(queue()), before);
    const auto given = parse_secret(text);
    const auto kept = kept_tokens(queue()).tokens;
    ASSERT_THAT(kept, SizeIs(1));
    EXPECT_EQ(kept[0].token.id, given.id);
    EXPECT_TRUE(is_same_secret(kept[0].secret_sha256, given.secret_sha256));
    EXPECT_TRUE(parse_secret("mac_00000000_1").id.empty());
    EXPECT_THAT(refusal_of([&] { create_token(queue(), of("anna", TokenScope::operator_)); }),
                HasSubstr("'anna' has tokens for 'upload', expected a new name for 'operator'"));
    EXPECT_EQ(revoke_tokens(queue(), "anna"), 1U);
    EXPECT_THAT(all_tokens(queue()), IsEmpty());
}

TEST_F(ServerTokens, ComeForAnInvitationAndAnotherInItsPlaceIfOneGotLost) {
    const auto invitation = create_invitation(
        queue(), {.owner = "ben", .expires_ms = 1'000'000, .token_expires_ms = 5'000'000});
    EXPECT_TRUE(kept_tokens(queue()).has_invitations);
    EXPECT_FALSE(take_invitation(queue(), create_token(queue(), of("anna")), 10));
    const auto lost = take_invitation(queue(), invitation, 10);
    const auto kept = take_invitation(queue(), invitation, 20);
    ASSERT_TRUE(lost && kept);
    EXPECT_NE(*lost, *kept);
    EXPECT_THAT(all_tokens(queue()), SizeIs(2));                 // anna's and one of ben's
    EXPECT_FALSE(take_invitation(queue(), invitation, 700'000)); // ten minutes later
}

TEST_F(ServerTokens, AreMadeByOperatorsAloneAndReadByImporters) {
    ServerConnection boss{server_.address(database_)};
    boss.run("DROP SCHEMA macadam CASCADE");
    {
        ServerTransaction one{boss};
        create_server_schema(boss);
        one.commit();
    }
    boss.run("CREATE ROLE viewer LOGIN IN ROLE macadam_reader;"
             " CREATE ROLE receiver LOGIN IN ROLE macadam_importer;"
             " CREATE ROLE chief LOGIN IN ROLE macadam_operator");
    ServerConnection viewer{server_.address(database_, "viewer")};
    ServerConnection receiver{server_.address(database_, "receiver")};
    ServerConnection chief{server_.address(database_, "chief")};
    EXPECT_FALSE(may_read_tokens(viewer));
    EXPECT_TRUE(may_read_tokens(receiver));
    EXPECT_THAT(refusal_of([&] { create_token(receiver, of("eve", TokenScope::operator_)); }),
                HasSubstr("permission denied"));
    EXPECT_THAT(refusal_of([&] { revoke_tokens(receiver, "anna"); }),
                HasSubstr("permission denied"));
    create_token(chief, of("anna"));
    EXPECT_THAT(kept_tokens(receiver).tokens, SizeIs(1));
    const auto invitation = create_invitation(
        chief, {.owner = "ben", .expires_ms = 1'000'000, .token_expires_ms = 5'000'000});
    EXPECT_TRUE(take_invitation(receiver, invitation, 10));
    EXPECT_THAT(refusal_of([&] { take_invitation(viewer, invitation, 10); }),
                HasSubstr("permission denied"));
    EXPECT_EQ(revoke_tokens(chief, "ben"), 1U);
    announce_logs(receiver, std::vector{log('a')});
    submit_logs(receiver, std::vector{log('a')}, {}, "anna");
    boss.run("UPDATE macadam.job SET state = 'imported', deleting = true");
    EXPECT_FALSE(has_deletions(receiver)); // to forget is the operator's
    EXPECT_TRUE(has_deletions(chief));
}

} // namespace
} // namespace macadam
