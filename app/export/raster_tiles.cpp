#include "app/export/raster_tiles.hpp"

#include "app/export/tile_square_painter.hpp"
#include "estimator/common/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <ctime>
#include <exception>
#include <functional>
#include <iterator>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace macadam {
namespace {

// A square holds whole label cells, and the margin drawn around it is small in comparison.
constexpr int square_px = 2048;

/// Limits the number of tiles: a remote town would add all tiles between.
void expect_area(const PicturePlan& plan) {
    constexpr std::uint64_t max_tiles = 50'000'000;
    std::uint64_t tiles = 0;
    for (int zoom = plan.min_zoom; zoom <= plan.max_zoom; ++zoom) {
        const auto range = tiles_of(plan.box, zoom);
        tiles +=
            std::uint64_t{range.last_x - range.first_x + 1} * (range.last_y - range.first_y + 1);
    }
    if (tiles > max_tiles) {
        throw InputError{fmt::format("the area needs {} tiles, expected at most {}: choose a "
                                     "lower --zoom or a smaller area with --bbox",
                                     tiles,
                                     max_tiles)};
    }
}

std::vector<TileSquare> squares_of(const PicturePlan& plan) {
    expect_area(plan);
    const auto across = static_cast<std::uint32_t>(square_px / plan.tile_px);
    std::vector<TileSquare> squares;
    for (int zoom = plan.min_zoom; zoom <= plan.max_zoom; ++zoom) {
        const auto range = tiles_of(plan.box, zoom);
        for (auto y = range.first_y / across * across; y <= range.last_y; y += across) {
            for (auto x = range.first_x / across * across; x <= range.last_x; x += across) {
                squares.push_back({{static_cast<std::uint8_t>(zoom), x, y},
                                   {std::max(x, range.first_x),
                                    std::max(y, range.first_y),
                                    std::min(x + across - 1, range.last_x),
                                    std::min(y + across - 1, range.last_y)}});
            }
        }
    }
    return squares;
}

std::size_t count_of(const std::vector<TileSquare>& squares) {
    std::size_t count = 0;
    for (const auto& [first, wanted] : squares) {
        count +=
            std::size_t{wanted.last_x - wanted.first_x + 1} * (wanted.last_y - wanted.first_y + 1);
    }
    return count;
}

// ------------------------------------------------------------------------ worker messages

/// Header of each message from a drawing process: a tile's bytes, or the reason of a failure.
struct Head {
    enum class Kind : std::uint32_t { tile, failure } kind;
    TileId tile;
    std::uint32_t bytes;
};

void write_all(int pipe, const void* data, std::size_t size) {
    const auto* at = static_cast<const char*>(data);
    while (size > 0) {
        const auto written = ::write(pipe, at, size);
        if (written < 0 && errno == EINTR) {
            continue;
        }
        if (written <= 0) {
            _exit(1); // the reader has gone
        }
        at += written;
        size -= static_cast<std::size_t>(written);
    }
}

void tell(int pipe, const Head& head, const void* bytes) {
    write_all(pipe, &head, sizeof head);
    write_all(pipe, bytes, head.bytes);
}

/// Ignores Ctrl-C in a drawing process, which would receive it with all processes of the terminal.
/// Its parent ends it, and it ends when the parent does.
void leave_signals_to_parent() {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        std::signal(signal, SIG_IGN);
    }
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
}

using TakeTile = std::function<void(const TileId& tile, std::string_view bytes)>;

/// Draws every `step`-th square in a process of its own; never returns.
[[noreturn]] void draw_part(const std::filesystem::path& store,
                            const PicturePlan& plan,
                            const LockWaitPolicy& wait_policy,
                            std::size_t first,
                            int pipe) {
    try {
        TileSquarePainter painter{
            StoreReader::open(store, wait_policy), plan.style, plan.tile_px, square_px};
        const auto squares = squares_of(plan);
        for (auto i = first; i < squares.size(); i += plan.jobs) {
            painter.draw(squares[i], [&](const TileId& tile, const std::vector<std::uint8_t>& png) {
                tell(pipe,
                     {Head::Kind::tile, tile, static_cast<std::uint32_t>(png.size())},
                     png.data());
            });
        }
    } catch (const std::exception& error) {
        const std::string_view why{error.what()};
        tell(pipe, {Head::Kind::failure, {}, static_cast<std::uint32_t>(why.size())}, why.data());
        _exit(1);
    }
    _exit(0);
}

/// Drawing process, with its output so far.
class Worker {
public:
    Worker(const std::filesystem::path& store,
           const PicturePlan& plan,
           const LockWaitPolicy& wait_policy,
           std::size_t number) {
        std::array<int, 2> ends{};
        if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
            throw InputError{fmt::format("cannot start drawing: {}", std::strerror(errno))};
        }
        process_ = ::fork();
        if (process_ == 0) {
            ::close(ends[0]);
            leave_signals_to_parent();
            draw_part(store, plan, wait_policy, number, ends[1]);
        }
        ::close(ends[1]);
        pipe_ = ends[0];
        if (process_ < 0) {
            ::close(pipe_);
            throw InputError{fmt::format("cannot start drawing: {}", std::strerror(errno))};
        }
    }
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;

    /// Kills an unfinished process, whose tiles are no longer wanted.
    ~Worker() {
        ::close(pipe_);
        if (!done_) {
            ::kill(process_, SIGKILL);
            ::waitpid(process_, nullptr, 0);
        }
    }

    int pipe() const { return pipe_; }
    bool is_done() const { return done_; }

    /// Reads available output and passes on complete messages.
    void listen(const TakeTile& take) {
        constexpr std::size_t at_once = 1 << 16;
        const auto before = received_.size();
        received_.resize(before + at_once);
        const auto got = ::read(pipe_, received_.data() + before, at_once);
        received_.resize(before + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
        active_at_ = Clock::now();
        if (got == 0) {
            expect_good_end();
            return;
        }
        std::size_t begin = 0;
        for (Head head{}; received_.size() - begin >= sizeof head;) {
            std::memcpy(&head, received_.data() + begin, sizeof head);
            const auto end = begin + sizeof head + head.bytes;
            if (end > received_.size()) {
                break;
            }
            const std::string_view bytes{received_.data() + begin + sizeof head, head.bytes};
            if (head.kind == Head::Kind::failure) {
                throw InputError{std::string{bytes}};
            }
            take(head.tile, bytes);
            begin = end;
        }
        received_.erase(received_.begin(), received_.begin() + static_cast<std::ptrdiff_t>(begin));
    }

    /// Checks that the process is working.
    /// \throws InputError  if it was stopped, or has neither written output nor used CPU time for
    ///                     longer than any wait for a disk.
    void expect_working() {
        const auto now = Clock::now();
        if (const auto used = cpu_time(); used != cpu_time_) {
            cpu_time_ = used;
            active_at_ = now;
        } else if (now - active_at_ > stall_limit) {
            throw InputError{fmt::format("a drawing process (PID {}) has made no progress for "
                                         "{} s; it was stopped or its disk does not respond",
                                         process_,
                                         stall_limit.count())};
        }
    }

private:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::seconds stall_limit{8};

    void expect_good_end() {
        int status = 0;
        ::waitpid(process_, &status, 0);
        done_ = true;
        if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
            throw InputError{WIFSIGNALED(status)
                                 ? fmt::format("a drawing process was ended by signal {} ({})",
                                               WTERMSIG(status),
                                               ::strsignal(WTERMSIG(status)))
                                 : std::string{"a drawing process has failed"}};
        }
    }

    /// Returns the CPU time of the process, ns; the last known value if it is unavailable.
    std::int64_t cpu_time() const {
        clockid_t clock{};
        timespec used{};
        if (::clock_getcpuclockid(process_, &clock) != 0 || ::clock_gettime(clock, &used) != 0) {
            return cpu_time_;
        }
        return std::int64_t{used.tv_sec} * 1'000'000'000 + used.tv_nsec;
    }

    pid_t process_ = -1;
    int pipe_ = -1;
    bool done_ = false;
    std::vector<char> received_;
    std::int64_t cpu_time_ = 0;
    Clock::time_point active_at_ = Clock::now();
};

void expect_not_stopped(const Progress& progress) {
    if (progress.stop.stop_requested()) {
        throw InputError{"stopped before the file was complete"};
    }
}

/// Requires a single thread. A forked child has only this one: a lock held by another, such as that
/// of the allocator, would stay locked for ever.
void expect_one_thread() {
    const auto threads = [] {
        const std::filesystem::directory_iterator tasks{"/proc/self/task"};
        return std::distance(begin(tasks), end(tasks));
    };
    constexpr int most_looks = 100; // the system lists a thread for a moment after it was joined
    for (int look = 1; threads() != 1; ++look) {
        if (look == most_looks) {
            throw std::logic_error{"drawing processes must be started before any thread"};
        }
        std::this_thread::sleep_for(std::chrono::milliseconds{1});
    }
}

} // namespace

struct PicturePainters::Impl {
    std::size_t tile_count = 0;
    std::vector<std::unique_ptr<Worker>> workers;
};

PicturePainters::PicturePainters(const std::filesystem::path& store,
                                 const PicturePlan& plan,
                                 LockWaitPolicy wait_policy)
    : impl_{std::make_unique<Impl>()} {
    expect_one_thread();
    const auto squares = squares_of(plan);
    impl_->tile_count = count_of(squares);
    for (std::size_t i = 0; i < std::min(plan.jobs, squares.size()); ++i) {
        impl_->workers.push_back(std::make_unique<Worker>(store, plan, wait_policy, i));
    }
}

PicturePainters::~PicturePainters() = default;

PictureCount PicturePainters::collect(const PutTile& put, const Progress& progress) {
    auto& workers = impl_->workers;
    PictureCount count;
    const TakeTile take = [&](const TileId& tile, std::string_view bytes) {
        put(tile, bytes);
        count.largest_bytes = std::max(count.largest_bytes, std::uint64_t{bytes.size()});
        constexpr std::size_t report_every = 100;
        if (++count.tiles % report_every == 0) {
            progress(count.tiles, impl_->tile_count);
        }
    };
    while (!workers.empty()) {
        std::vector<pollfd> pipes;
        for (const auto& worker : workers) {
            pipes.push_back({worker->pipe(), POLLIN, 0});
        }
        constexpr int stop_check_ms = 200; // time to notice a stop request
        ::poll(pipes.data(), pipes.size(), stop_check_ms);
        expect_not_stopped(progress);
        for (std::size_t i = 0; i < workers.size(); ++i) {
            if (pipes[i].revents != 0) {
                workers[i]->listen(take);
            } else {
                workers[i]->expect_working();
            }
        }
        std::erase_if(workers, [](const auto& worker) { return worker->is_done(); });
    }
    progress(impl_->tile_count, impl_->tile_count);
    return count;
}

} // namespace macadam
