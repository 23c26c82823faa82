#include "app/interruption.hpp"

#include <csignal>

namespace macadam {
namespace {

sigset_t interrupting_signals() {
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGINT);
    sigaddset(&signals, SIGTERM);
    return signals;
}

/// Ends the process as if nobody had waited for the signal.
void cut_off(int signal) {
    std::signal(signal, SIG_DFL);
    const auto signals = interrupting_signals();
    pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
    raise(signal);
}

} // namespace

Interruption::Interruption() {
    const auto signals = interrupting_signals();
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    watcher_ = std::jthread{[this](const std::stop_token& over) { watch(over); }};
}

Interruption::~Interruption() {
    watcher_.request_stop();
    pthread_kill(watcher_.native_handle(), SIGTERM); // wakes it; it knows that it is over
    watcher_.join();
    const auto signals = interrupting_signals();
    pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
}

void Interruption::watch(const std::stop_token& over) {
    const auto signals = interrupting_signals();
    int signal = 0;
    while (sigwait(&signals, &signal) == 0 && !over.stop_requested()) {
        if (stop_.stop_requested()) {
            cut_off(signal);
        }
        stop_.request_stop();
    }
}

} // namespace macadam
