#include "app/progress/progress_display.hpp"

#include "app/progress/remaining_time.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <memory>
#include <string_view>
#include <utility>

namespace macadam {
namespace {

using namespace std::chrono_literals;
using Clock = RemainingTime::Clock;

constexpr std::size_t bar_width = 30;
constexpr auto line_every = 30s;

std::atomic<bool> has_bar = false;

std::string spoken(std::chrono::seconds left) {
    constexpr auto shortest_in_minutes = 2min;
    constexpr auto shortest_in_hours = 2h;
    if (left < shortest_in_minutes) {
        return fmt::format(", {} s left", left.count());
    }
    return left < shortest_in_hours
               ? fmt::format(", {} min left",
                             std::chrono::round<std::chrono::minutes>(left).count())
               : fmt::format(", {} h left", std::chrono::round<std::chrono::hours>(left).count());
}

void write_bar(const std::string& label,
               std::size_t done,
               std::size_t whole,
               std::string_view text) {
    const auto full = whole == 0 ? 0 : bar_width * std::min(done, whole) / whole;
    std::fputs(fmt::format("\r{} [{:<{}}] {}\033[K", label, std::string(full, '='), bar_width, text)
                   .c_str(),
               stderr);
    std::fflush(stderr);
    has_bar = true;
}

/// Display of one task. Called by one thread at a time.
class Display {
public:
    Display(std::string label, ProgressUnit unit, bool on_terminal)
        : label_{std::move(label)}, unit_{std::move(unit)}, on_terminal_{on_terminal} {}

    void show(std::size_t done, std::size_t whole) {
        const auto now = Clock::now();
        time_.add(now, done);
        if (done == whole) {
            clear_progress_bar();
            shown_.clear();
        } else if (on_terminal_) {
            if (auto text = progress_text(unit_, done, whole, time_.left(whole));
                text != shown_ || !has_bar) {
                write_bar(label_, done, whole, text);
                shown_ = std::move(text);
            }
        } else if (now - line_at_ >= line_every) {
            line_at_ = now;
            std::fputs(fmt::format(
                           "{}: {}\n", label_, progress_text(unit_, done, whole, time_.left(whole)))
                           .c_str(),
                       stderr);
        }
    }

private:
    std::string label_;
    ProgressUnit unit_;
    bool on_terminal_;
    Clock::time_point line_at_ = Clock::now();
    RemainingTime time_{line_at_};
    std::string shown_;
};

} // namespace

std::string progress_text(const ProgressUnit& unit,
                          std::size_t done,
                          std::size_t whole,
                          std::optional<std::chrono::seconds> left) {
    const auto time = left ? spoken(*left) : std::string{};
    if (unit.name.empty()) {
        return whole == 0 ? std::string{"..."} : fmt::format("{:3d} %{}", 100 * done / whole, time);
    }
    const auto units = done / unit.parts;
    return whole == 0 ? fmt::format("{} {}s", units, unit.name)
                      : fmt::format("{}/{} {}s{}", units, whole / unit.parts, unit.name, time);
}

Progress progress_display(std::string label, ProgressUnit unit, bool on_terminal) {
    auto display = std::make_shared<Display>(std::move(label), std::move(unit), on_terminal);
    return {
        .report = [display](std::size_t done, std::size_t whole) { display->show(done, whole); },
        .stop = {}};
}

void clear_progress_bar() {
    if (has_bar.exchange(false)) {
        std::fputs("\r\033[K", stderr);
        std::fflush(stderr);
    }
}

} // namespace macadam
