#include "storage/postgres/server_connection.hpp"

#include "storage/postgres/idle_limit.hpp"
#include "storage/postgres/server_array.hpp"
#include "support/program/postgres_server.hpp"

#include <gmock/gmock.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace macadam::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class ServerConnections : public ::testing::Test {
protected:
    ServerConnections() {
        server_.run("DROP TABLE IF EXISTS public.number;"
                    "CREATE TABLE public.number (value integer UNIQUE)");
    }

    std::int64_t count() {
        return ServerConnection{address_}.number("SELECT count(*) FROM public.number");
    }

    static PostgresServer& one_server() {
        static PostgresServer server{std::chrono::seconds{1700}}; // for all tests of this process
        return server;
    }

    std::string address_ = one_server().address();
    ServerConnection server_{address_};
    const ServerStatement insert_{"INSERT INTO public.number VALUES ($1::integer) RETURNING value"};
    const ServerStatement divide_{"SELECT 1 / $1::integer"};

    static ServerStatement with(ServerStatement statement, int value) {
        statement.values = {std::to_string(value)};
        return statement;
    }
};

TEST_F(ServerConnections, RunStatementsTogetherAndTellWhatEachGave) {
    const std::array all{with(insert_, 7), with(divide_, 1), with(insert_, 8)};
    const std::vector<std::vector<ServerRow>> expected{{{"7"}}, {{"1"}}, {{"8"}}};
    EXPECT_EQ(server_.rows_of_all(all), expected);
}

TEST_F(ServerConnections, RunNoStatementAfterOneThatFailsAndGoOnLater) {
    const std::array all{with(insert_, 1), with(divide_, 0), with(insert_, 2)};
    for (int repetition = 0; repetition < 2; ++repetition) { // prepared for the first time, and not
        ServerTransaction one{server_};
        EXPECT_THAT([&] { server_.rows_of_all(all); },
                    ThrowsMessage<InputError>(HasSubstr("the server refused: division by zero")));
    }
    EXPECT_EQ(count(), 0);
    EXPECT_EQ(server_.rows_of_all(std::array{with(divide_, 1)}).at(0).at(0).at(0), "1");
}

TEST_F(ServerConnections, SeeWhatOthersCommitWhateverTheRolesDefault) {
    ServerConnection strict{address_ +
                            "&options=-c%20default_transaction_isolation%3Dserializable"};
    ServerTransaction one{strict};
    EXPECT_EQ(strict.number("SELECT count(*) FROM public.number"), 0);
    server_.rows_of_all(std::array{with(insert_, 1)});
    EXPECT_EQ(strict.number("SELECT count(*) FROM public.number"), 1);
}

TEST_F(ServerConnections, CommitTheLastStatementsOrNothing) {
    {
        ServerTransaction one{server_};
        server_.rows_of_all(std::array{with(insert_, 1)});
        EXPECT_THAT([&] { one.commit(std::array{with(insert_, 1)}); },
                    ThrowsMessage<InputError>(HasSubstr("the server refused: duplicate key")));
        server_.roll_back();
    }
    EXPECT_EQ(count(), 0);
    ServerTransaction one{server_};
    server_.rows_of_all(std::array{with(insert_, 1)});
    one.commit(std::array{with(insert_, 2)});
    EXPECT_EQ(count(), 2);
}

TEST_F(ServerConnections, BeginTransactionsWithTheirFirstStatement) {
    const std::string others = "SELECT count(*) FROM pg_stat_activity WHERE state LIKE 'idle in%'";
    ServerConnection watch{address_};
    {
        ServerTransaction nothing{server_};
        EXPECT_EQ(watch.number(others), 0);
        nothing.commit();
    }
    EXPECT_TRUE(server_.take_warnings().empty()); // none of a COMMIT without a transaction
    ServerTransaction one{server_, true};
    EXPECT_EQ(server_.number("SELECT count(*) FROM public.number"), 0);
    EXPECT_EQ(watch.number(others), 1);
    watch.run("INSERT INTO public.number VALUES (1)");
    EXPECT_EQ(server_.number("SELECT count(*) FROM public.number"), 0); // one moment
}

TEST_F(ServerConnections, TellTroubleOfTheServerFromWhatItRefuses) {
    const auto fail_with = [&](const std::string& state) {
        server_.run("DO $$ BEGIN RAISE 'so it ended' USING ERRCODE = '" + state + "'; END $$");
    };
    for (const auto* const state : {"57014", "40001", "40P01", "55P03", "25P03"}) {
        EXPECT_THAT([&] { fail_with(state); },
                    ThrowsMessage<ServerTrouble>(HasSubstr("so it ended; run the command again")))
            << state;
    }
    for (const auto* const state : {"08006", "53300", "57P01", "58030"}) {
        EXPECT_THROW(fail_with(state), ServerTrouble) << state;
    }
    for (const auto* const state : {"23505", "42P01", "22012", "25P02"}) {
        try {
            fail_with(state);
            ADD_FAILURE() << state;
        } catch (const ServerTrouble&) {
            ADD_FAILURE() << state;
        } catch (const InputError& error) {
            EXPECT_THAT(error.what(), HasSubstr("so it ended"));
        }
    }
}

TEST_F(ServerConnections, AreEndedByTheServerWhenTheyStandStillInATransaction) {
    ServerConnection frozen{address_ + "&options=-c%20idle_in_transaction_session_timeout%3D100ms"};
    ServerTransaction one{frozen};
    frozen.rows_of_all(std::array{with(insert_, 1)});
    server_.run("INSERT INTO public.number VALUES (1)"); // waits until the other row is gone
    EXPECT_THAT([&] { one.commit(); }, ThrowsMessage<ServerTrouble>(HasSubstr("in doubt")));
}

TEST_F(ServerConnections, LimitHowLongTransactionsAreIdleUnlessTheAdministratorDoes) {
    const std::string limit = "SELECT current_setting('idle_in_transaction_session_timeout')";
    EXPECT_EQ(server_.rows(limit).at(0).at(0), "1min");
    ServerConnection patient{address_ + "&options=-c%20idle_in_transaction_session_timeout%3D1h"};
    EXPECT_EQ(patient.rows(limit).at(0).at(0), "1h");
    {
        ServerTransaction one{server_};
        EXPECT_EQ(set_idle_limit(server_, "0"), "1min");
        EXPECT_EQ(server_.rows(limit).at(0).at(0), "0");
        EXPECT_EQ(set_idle_limit(server_, "1min"), "0");
    }
    EXPECT_EQ(server_.rows(limit).at(0).at(0), "1min");
    ServerTransaction reading{server_, true};
    EXPECT_EQ(server_.rows(limit).at(0).at(0), "0");
}

TEST_F(ServerConnections, TakeArraysOfAnyText) {
    const std::vector<std::optional<std::string_view>> texts{
        "plain", "", "NULL", "a,b", "{c}", R"(quo"ted)", R"(back\slash)", "ä", std::nullopt};
    const auto rows = server_.rows("SELECT * FROM unnest($1::text[])", {array_of(texts)});
    ASSERT_EQ(rows.size(), texts.size());
    for (std::size_t i = 0; i < texts.size(); ++i) {
        EXPECT_EQ(rows[i][0].has_value(), texts[i].has_value());
        EXPECT_EQ(rows[i][0].value_or(""), texts[i].value_or(""));
    }
    EXPECT_EQ(array_of(std::vector<std::int64_t>{-1, 2}), "{-1,2}");
    EXPECT_EQ(array_of(std::vector<std::int64_t>{}), "{}");
}

} // namespace
} // namespace macadam::testing
