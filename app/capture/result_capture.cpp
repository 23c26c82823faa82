#include "app/capture/result_capture.hpp"

#include <limits>
#include <stdexcept>
#include <utility>
#include <variant>

namespace macadam {
namespace {

thread_local ResultCapture* of_this_thread = nullptr; // NOLINT(*-avoid-non-const-global-variables)

double real_of(const Cell::Value& value) {
    if (const auto* const real = std::get_if<double>(&value)) {
        return *real;
    }
    const auto* const integer = std::get_if<std::int64_t>(&value);
    return integer != nullptr ? static_cast<double>(*integer)
                              : std::numeric_limits<double>::quiet_NaN();
}

std::int64_t integer_of(const Cell::Value& value) {
    if (const auto* const truth = std::get_if<bool>(&value)) {
        return *truth ? 1 : 0;
    }
    const auto* const integer = std::get_if<std::int64_t>(&value);
    return integer != nullptr ? *integer : 0;
}

} // namespace

void CapturedColumn::add(const Cell& cell) {
    is_known.push_back(cell.is_known());
    switch (type.kind) {
    case ColumnType::Kind::real:
        reals.push_back(real_of(cell.value()));
        break;
    case ColumnType::Kind::integer:
    case ColumnType::Kind::truth:
        integers.push_back(integer_of(cell.value()));
        break;
    case ColumnType::Kind::text:
    case ColumnType::Kind::day:
    case ColumnType::Kind::raw: {
        const auto* const text = std::get_if<std::string>(&cell.value());
        texts.push_back(text != nullptr ? *text : std::string{});
        break;
    }
    }
}

ResultCapture::ResultCapture(bool with_features) : with_features_{with_features} {
    if (of_this_thread != nullptr) {
        throw std::logic_error{"this thread captures already"};
    }
    of_this_thread = this;
}

ResultCapture::~ResultCapture() {
    of_this_thread = nullptr;
}

ResultCapture* ResultCapture::current() {
    return of_this_thread;
}

void ResultCapture::begin(CapturedTable table) {
    if (result_.table) {
        throw std::logic_error{"the command writes a second table"};
    }
    result_.table = std::move(table);
}

} // namespace macadam
