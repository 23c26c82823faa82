#pragma once

#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>
#include <utility>
#include <vector>

namespace macadam {

/// Worker pool that returns the results in the order of the items. Workers stay at most two items a
/// worker before the caller, so that memory is bounded.
template <typename Item, typename Result>
class OrderedWorkerPool {
public:
    using Supply = std::function<std::optional<Item>()>;
    using Work = std::function<Result(const Item&)>;
    using Deadline = std::optional<std::chrono::steady_clock::time_point>; ///< nullopt: none

    OrderedWorkerPool(Supply supply, std::size_t jobs, Work work)
        : ahead_{2 * jobs}, supply_{std::move(supply)}, work_{std::move(work)} {
        for (std::size_t i = 0; i < jobs; ++i) {
            workers_.emplace_back([this](const std::stop_token& stop) { worker_loop(stop); });
        }
    }

    struct Taken {
        std::optional<Result> result; ///< `std::nullopt`: not ready yet, or over
        bool over = false;            ///< there is no such item
    };

    /// Waits for a result, until the deadline or a stop request at the latest.
    Taken take(std::size_t number, const Deadline& until, const std::stop_token& stop) {
        constexpr std::chrono::milliseconds look_every{50};
        std::unique_lock lock{mutex_};
        const auto is_over = [&] { return count_ && number >= *count_; };
        const auto is_there = [&] { return done_.contains(number) || failure_ || is_over(); };
        while (!changed_.wait_for(lock, look_every, is_there)) {
            if (stop.stop_requested() || (until && std::chrono::steady_clock::now() >= *until)) {
                return {};
            }
        }
        if (failure_) {
            std::rethrow_exception(failure_);
        }
        if (is_over()) {
            return {.result = {}, .over = true};
        }
        auto result = std::move(done_.extract(number).mapped());
        taken_ = number + 1;
        changed_.notify_all();
        return {.result = std::move(result)};
    }

private:
    struct Task {
        std::size_t number;
        Item item;
    };

    /// Takes the next item when there is room for it. Only one worker at a time asks, to keep the
    /// order; the others continue while it is extracted from an archive.
    std::optional<Task> next_task(const std::stop_token& stop) {
        const std::scoped_lock asking{asking_};
        {
            std::unique_lock lock{mutex_};
            const auto has_room = [&] { return given_ < taken_ + ahead_; };
            if (!changed_.wait(lock, stop, has_room) || stop.stop_requested() || count_) {
                return std::nullopt;
            }
        }
        auto item = supply_();
        const std::scoped_lock lock{mutex_};
        if (!item) {
            count_ = given_;
            changed_.notify_all();
            return std::nullopt;
        }
        return Task{given_++, std::move(*item)};
    }

    void worker_loop(const std::stop_token& stop) {
        try {
            while (auto task = next_task(stop)) {
                auto result = work_(task->item);
                const std::scoped_lock lock{mutex_};
                done_.emplace(task->number, std::move(result));
                changed_.notify_all();
            }
        } catch (...) {
            const std::scoped_lock lock{mutex_};
            failure_ = std::current_exception();
            changed_.notify_all();
        }
    }

    std::size_t ahead_;
    Supply supply_;
    Work work_;
    std::mutex asking_;
    std::mutex mutex_;
    std::condition_variable_any changed_;
    std::map<std::size_t, Result> done_;
    std::size_t given_ = 0;
    std::size_t taken_ = 0;
    std::optional<std::size_t> count_; ///< total, once known
    std::exception_ptr failure_;
    // Last member: workers stop before the members they use are destroyed.
    std::vector<std::jthread> workers_;
};

} // namespace macadam
