#include "storage/postgres/copy_stream.hpp"

#include "estimator/common/error.hpp"
#include "storage/postgres/server_result.hpp"

#include <fmt/format.h>
#include <libpq-fe.h>

#include <bit>
#include <concepts>
#include <utility>

namespace macadam {
namespace {

constexpr std::string_view signature{"PGCOPY\n\377\r\n\0", 11};
constexpr std::size_t header_size = 19; // signature, flags, length of the extension
constexpr std::size_t send_at = 1 << 16;
constexpr std::size_t longest_row = std::size_t{64} << 20;  // far above any of ours
constexpr std::size_t longest_field = std::size_t{1} << 30; // by PostgreSQL

template <std::unsigned_integral Number>
void append_number(std::string& to, Number number) {
    for (int shift = static_cast<int>(sizeof number) * 8 - 8; shift >= 0; shift -= 8) {
        to.push_back(static_cast<char>(static_cast<unsigned char>(number >> shift)));
    }
}

/// Big-endian number of all bytes, at most eight.
std::uint64_t number_in(std::string_view bytes) {
    std::uint64_t number = 0;
    for (const char byte : bytes) {
        number = number << 8 | static_cast<unsigned char>(byte);
    }
    return number;
}

std::string_view taken(std::string_view& bytes, std::size_t size) {
    const auto front = bytes.substr(0, size);
    bytes.remove_prefix(size);
    return front;
}

} // namespace

// -------------------------------------------------------------------------------------- writing

CopyWriter::CopyWriter(ServerConnection& server, const std::string& into, int columns)
    : server_{&server}, columns_{columns} {
    const auto sql =
        server.with_begin(fmt::format("COPY {} FROM STDIN WITH (FORMAT binary)", into));
    const ServerResult result{PQexec(server.handle(), sql.c_str())};
    if (PQresultStatus(result.get()) != PGRES_COPY_IN) {
        server.fail("the server refused", result.get());
    }
    buffer_ = signature;
    buffer_.append(header_size - signature.size(), '\0');
}

void CopyWriter::begin_row() {
    append_number(buffer_, static_cast<std::uint16_t>(columns_));
}

void CopyWriter::put(std::int16_t value) {
    append_number(buffer_, std::uint32_t{sizeof value});
    append_number(buffer_, static_cast<std::uint16_t>(value));
}

void CopyWriter::put(std::int32_t value) {
    append_number(buffer_, std::uint32_t{sizeof value});
    append_number(buffer_, static_cast<std::uint32_t>(value));
}

void CopyWriter::put(std::int64_t value) {
    append_number(buffer_, std::uint32_t{sizeof value});
    append_number(buffer_, static_cast<std::uint64_t>(value));
}

void CopyWriter::put(double value) {
    append_number(buffer_, std::uint32_t{sizeof value});
    append_number(buffer_, std::bit_cast<std::uint64_t>(value));
}

void CopyWriter::put(bool value) {
    append_number(buffer_, std::uint32_t{1});
    buffer_.push_back(value ? 1 : 0);
}

void CopyWriter::put_field(std::string_view bytes) {
    if (bytes.size() >= longest_field) {
        throw InputError{fmt::format("{}: a value of {} bytes is too long for PostgreSQL",
                                     server_->address(),
                                     bytes.size())};
    }
    append_number(buffer_, static_cast<std::uint32_t>(bytes.size()));
    buffer_ += bytes;
}

void CopyWriter::put(std::string_view text) {
    put_field(server_text(text));
}

void CopyWriter::put(ServerBytes value) {
    put_field(value.bytes);
}

void CopyWriter::put(std::nullopt_t) {
    append_number(buffer_, ~std::uint32_t{0});
}

void CopyWriter::end_row() {
    if (buffer_.size() >= send_at) {
        send();
    }
}

void CopyWriter::send() {
    if (PQputCopyData(server_->handle(), buffer_.data(), static_cast<int>(buffer_.size())) != 1) {
        server_->fail("the connection broke, nothing was written", nullptr);
    }
    buffer_.clear();
}

void CopyWriter::finish() {
    append_number(buffer_, static_cast<std::uint16_t>(~0U));
    send();
    if (PQputCopyEnd(server_->handle(), nullptr) != 1) {
        server_->fail("the connection broke, nothing was written", nullptr);
    }
    ServerResult last;
    for (ServerResult result{PQgetResult(server_->handle())}; result;
         result.reset(PQgetResult(server_->handle()))) {
        last = std::move(result);
        if (PQresultStatus(last.get()) != PGRES_COMMAND_OK) {
            server_->fail("the server refused the rows", last.get());
        }
    }
}

// -------------------------------------------------------------------------------------- reading

void CopyRow::refuse(const std::string& what) const {
    throw InputError{fmt::format("{}: {} in table {}; the database was modified by another program",
                                 server_->address(),
                                 what,
                                 *table_)};
}

void CopyRow::decode(std::string_view bytes, int columns) {
    if (bytes.size() > longest_row) {
        refuse(fmt::format("a row of {} bytes", bytes.size()));
    }
    if (bytes.size() < 2 || number_in(taken(bytes, 2)) != static_cast<std::uint64_t>(columns)) {
        refuse("a row of another number of columns");
    }
    fields_.clear();
    for (int column = 0; column < columns; ++column) {
        if (bytes.size() < 4) {
            refuse("a torn row");
        }
        const auto size = static_cast<std::uint32_t>(number_in(taken(bytes, 4)));
        if (size == ~std::uint32_t{0}) {
            fields_.emplace_back(std::nullopt);
        } else if (size > bytes.size()) {
            refuse("a torn row");
        } else {
            fields_.emplace_back(taken(bytes, size));
        }
    }
    if (!bytes.empty()) {
        refuse("a torn row");
    }
}

bool CopyRow::is_null(int column) const {
    return !fields_[static_cast<std::size_t>(column)];
}

std::string_view CopyRow::field(int column, std::size_t size) const {
    const auto& value = fields_[static_cast<std::size_t>(column)];
    if (!value || value->size() != size) {
        refuse(fmt::format("an unexpected value of column {}", column + 1));
    }
    return *value;
}

std::int64_t CopyRow::integer(int column) const {
    const auto& value = fields_[static_cast<std::size_t>(column)];
    const auto size = value ? value->size() : 0;
    const auto number = number_in(field(column, size == 2 || size == 4 ? size : 8));
    return size == 2   ? static_cast<std::int16_t>(number)
           : size == 4 ? static_cast<std::int32_t>(number)
                       : static_cast<std::int64_t>(number);
}

std::optional<std::int64_t> CopyRow::known_integer(int column) const {
    return is_null(column) ? std::nullopt : std::optional{integer(column)};
}

double CopyRow::real(int column) const {
    return std::bit_cast<double>(number_in(field(column, 8)));
}

bool CopyRow::boolean(int column) const {
    return field(column, 1)[0] != 0;
}

std::string_view CopyRow::bytes(int column) const {
    return fields_[static_cast<std::size_t>(column)].value_or(std::string_view{});
}

CopyReader::CopyReader(ServerConnection& server,
                       const std::string& source,
                       std::string table,
                       int columns)
    : server_{&server}, table_{std::move(table)}, row_{server, table_}, columns_{columns} {
    const auto sql =
        server.with_begin(fmt::format("COPY {} TO STDOUT WITH (FORMAT binary)", source));
    const ServerResult result{PQexec(server.handle(), sql.c_str())};
    if (PQresultStatus(result.get()) != PGRES_COPY_OUT) {
        server.fail("the server refused", result.get());
    }
}

CopyReader::~CopyReader() {
    PQfreemem(buffer_);
}

bool CopyReader::next() {
    while (!is_over_) {
        PQfreemem(std::exchange(buffer_, nullptr));
        const int size = PQgetCopyData(server_->handle(), &buffer_, 0);
        if (size < 0) {
            is_over_ = true;
            for (ServerResult result{PQgetResult(server_->handle())}; result;
                 result.reset(PQgetResult(server_->handle()))) {
                if (PQresultStatus(result.get()) != PGRES_COMMAND_OK) {
                    server_->fail("reading failed", result.get());
                }
            }
            return false;
        }
        // The server sends each row as one message; the header comes before the first one.
        std::string_view bytes{buffer_, static_cast<std::size_t>(size)};
        if (std::exchange(is_first_, false)) {
            if (!bytes.starts_with(signature) || bytes.size() < header_size ||
                number_in(bytes.substr(signature.size(), 8)) != 0) {
                server_->fail("the server sent something else than rows", nullptr);
            }
            bytes.remove_prefix(header_size);
        }
        constexpr std::string_view trailer{"\377\377", 2};
        if (!bytes.empty() && bytes != trailer) {
            row_.decode(bytes, columns_);
            return true;
        }
    }
    return false;
}

} // namespace macadam
