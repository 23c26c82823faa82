#pragma once

#include "storage/sqlite.hpp"

#include <map>
#include <string>

namespace macadam {

/// Statements of one database that are asked again and again, each compiled once. They go before
/// the database does.
class KeptStatements {
public:
    /// A statement on loan. It ends its reading when it goes back: one that stays in the middle of
    /// its rows keeps the moment that it reads alive.
    class Loan {
    public:
        Loan(KeptStatements& keeper, std::string sql);
        Loan(const Loan&) = delete;
        Loan& operator=(const Loan&) = delete;
        ~Loan();

        Statement& operator*() { return statement_; }
        Statement* operator->() { return &statement_; }

    private:
        KeptStatements* keeper_;
        std::string sql_;
        Statement statement_;
    };

    explicit KeptStatements(Database& database) : database_{&database} {}

private:
    /// Who asks while another has the statement gets one of his own.
    Statement taken(const std::string& sql);

    Database* database_;
    std::map<std::string, Statement> idle_; ///< by their text
};

} // namespace macadam
