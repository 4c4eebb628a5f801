// app/signals.cpp - signals that ask for a stop or a checkpoint, and the true end by one.
// SPDX-License-Identifier: Apache-2.0
#include "app/signals.h"

#include <csignal>

namespace obscura::app {

namespace {

// Written by the handler: only lock-free atomics are allowed there.
std::atomic<bool> stop_requested{false};
std::atomic<int> stop_signal{0};
std::atomic<bool> save_requested{false};
std::atomic<int> living{0};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

void set_handler(int signal, void (*handler)(int)) {
    struct sigaction action = {};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaction(signal, &action, nullptr);
}

void on_stop_signal(int signal) {
    int none = 0;
    stop_signal.compare_exchange_strong(none, signal);
    stop_requested.store(true);
    if (signal == SIGINT) set_handler(SIGINT, SIG_DFL);
}

void on_save_signal(int /*signal*/) {
    save_requested.store(true);
}

/// A parent such as nohup may have asked that a signal be ignored: that stays so.
void handle_unless_ignored(int signal, void (*handler)(int) = on_stop_signal) {
    struct sigaction current = {};
    sigaction(signal, nullptr, &current);
    if (current.sa_handler != SIG_IGN) set_handler(signal, handler);
}

void restore_unless_ignored(int signal) {
    struct sigaction current = {};
    sigaction(signal, nullptr, &current);
    if (current.sa_handler != SIG_IGN) set_handler(signal, SIG_DFL);
}

}  // namespace

void ignore_broken_pipes() {
    set_handler(SIGPIPE, SIG_IGN);
}

StopOnSignal::StopOnSignal(Kind kind) : kind_(kind), is_first_(living++ == 0) {
    if (!is_first_) {
        clear_unless_signal();  // of a time limit
        return;
    }
    stop_requested.store(false);
    stop_signal.store(0);
    save_requested.store(false);
    handle_unless_ignored(SIGINT);
    handle_unless_ignored(SIGTERM);
    if (kind_ == Kind::stops) return;
    handle_unless_ignored(SIGUSR1);
    handle_unless_ignored(SIGHUP, on_save_signal);
}

StopOnSignal::~StopOnSignal() {
    --living;
    if (!is_first_) return;
    restore_unless_ignored(SIGINT);
    restore_unless_ignored(SIGTERM);
    if (kind_ == Kind::stops) return;
    restore_unless_ignored(SIGUSR1);
    restore_unless_ignored(SIGHUP);
}

const std::atomic<bool>& StopOnSignal::flag() const {
    return stop_requested;
}

void StopOnSignal::stop() {
    stop_requested.store(true);
}

void StopOnSignal::clear_unless_signal() {
    if (stop_signal.load() == 0) stop_requested.store(false);
    if (stop_signal.load() != 0) stop_requested.store(true);  // it came in between
}

bool StopOnSignal::take_save_request() {
    return save_requested.exchange(false);
}

int received_stop_signal() {
    return stop_signal.load();
}

void end_by_signal(int signal) {
    set_handler(signal, SIG_DFL);
    raise(signal);
}

}  // namespace obscura::app
