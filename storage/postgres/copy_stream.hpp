#pragma once

#include "storage/postgres/server_connection.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Bytes for a column of type bytea or geometry.
struct ServerBytes {
    std::string_view bytes;
};

/// Writes rows of a table in PostgreSQL's binary COPY format. std::int16_t, std::int32_t,
/// std::int64_t, double and bool are for columns of just that type.
///
/// Source: PostgreSQL 15, manual page of COPY, "Binary Format".
class CopyWriter {
public:
    /// \param into  "table (column, ...)", qualified; never user input, because it is not quoted.
    CopyWriter(ServerConnection& server, const std::string& into, int columns);

    template <typename... Values>
    void add(const Values&... values) {
        begin_row();
        (put(values), ...);
        end_row();
    }

    // The same column by column.
    void begin_row();
    void put(std::int16_t value);
    void put(std::int32_t value);
    void put(std::int64_t value);
    void put(double value);
    void put(bool value);
    void put(std::string_view text); ///< as server_text()
    void put(const std::string& text) { put(std::string_view{text}); }
    void put(const char* text) { put(std::string_view{text}); }
    void put(ServerBytes value);
    void put(std::nullopt_t);
    template <typename Value>
    void put(const std::optional<Value>& value) {
        if (value) {
            put(*value);
        } else {
            put(std::nullopt);
        }
    }
    void end_row();

    /// Ends the COPY; the rows are in the table afterwards.
    void finish();

private:
    void send();
    void put_field(std::string_view bytes);

    ServerConnection* server_;
    std::string buffer_;
    int columns_;
};

/// Row of a binary COPY; valid until the next one.
class CopyRow {
public:
    CopyRow(const ServerConnection& server, const std::string& table)
        : server_{&server}, table_{&table} {}

    /// Decodes one row. \throws InputError  if it has another number of columns, or torn ones.
    void decode(std::string_view bytes, int columns);

    bool is_null(int column) const;
    std::int64_t integer(int column) const; ///< of 2, 4 or 8 bytes
    std::optional<std::int64_t> known_integer(int column) const;
    double real(int column) const;
    bool boolean(int column) const;
    std::string_view bytes(int column) const; ///< of text, bytea or geometry; "" for NULL

private:
    std::string_view field(int column, std::size_t size) const;
    [[noreturn]] void refuse(const std::string& what) const;

    const ServerConnection* server_;
    const std::string* table_;
    std::vector<std::optional<std::string_view>> fields_;
};

/// Reads rows in the same format. A value of another type than expected is refused by name.
class CopyReader {
public:
    /// \param source  "table (column, ...)" or "(SELECT ...)", of our own.
    /// \param table  for messages
    CopyReader(ServerConnection& server, const std::string& source, std::string table, int columns);
    CopyReader(const CopyReader&) = delete;
    CopyReader& operator=(const CopyReader&) = delete;
    ~CopyReader();

    /// \returns false at the end.
    bool next();

    const CopyRow& row() const { return row_; }

private:
    ServerConnection* server_;
    std::string table_;
    CopyRow row_;
    int columns_;
    char* buffer_ = nullptr;
    bool is_first_ = true;
    bool is_over_ = false;
};

} // namespace macadam
