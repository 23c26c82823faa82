#pragma once

#include <stop_token>
#include <thread>

namespace macadam {

/// While it lives, Ctrl-C and `kill` ask the work to come to an end of its own instead of cutting
/// it off: `stop()` says so. A second one cuts off after all.
///
/// Make it before threads are started, so that they leave the signals to it. One at a time.
class Interruption {
public:
    Interruption();
    Interruption(const Interruption&) = delete;
    Interruption& operator=(const Interruption&) = delete;
    ~Interruption();

    std::stop_token stop() const { return stop_.get_token(); }

private:
    void watch(const std::stop_token& over);

    std::stop_source stop_;
    std::jthread watcher_;
};

} // namespace macadam
