#pragma once

#include "storage/sqlite/sqlite.hpp"

#include <map>
#include <string>

namespace macadam {

/// Statements of one database that are asked again and again, each compiled once. They go before
/// the database does.
class StatementCache {
public:
    /// A statement on loan. It ends its reading when it goes back: one that stays in the middle of
    /// its rows keeps the moment that it reads alive.
    class Loan {
    public:
        Loan(StatementCache& keeper, std::string sql);
        Loan(const Loan&) = delete;
        Loan& operator=(const Loan&) = delete;
        ~Loan();

        Statement& operator*() { return statement_; }
        Statement* operator->() { return &statement_; }

    private:
        StatementCache* keeper_;
        std::string sql_;
        Statement statement_;
    };

    explicit StatementCache(Database& database) : database_{&database} {}

private:
    /// Who asks while another has the statement gets one of his own.
    Statement taken(const std::string& sql);

    Database* database_;
    std::map<std::string, Statement> idle_; ///< by their text
};

} // namespace macadam
