// app/signals.cpp - SIGINT and SIGTERM: an orderly stop while rendering, an immediate end before.
// SPDX-License-Identifier: Apache-2.0
#include "app/signals.h"

#include <csignal>

namespace obscura::app {

namespace {

// Written by the handler: only lock-free atomics are allowed there.
std::atomic<bool> stop_requested{false};
std::atomic<int> stop_signal{0};
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

/// A parent such as nohup may have asked that a signal be ignored: that stays so.
void handle_unless_ignored(int signal) {
    struct sigaction current = {};
    sigaction(signal, nullptr, &current);
    if (current.sa_handler != SIG_IGN) set_handler(signal, on_stop_signal);
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

StopOnSignal::StopOnSignal() {
    stop_requested.store(false);
    stop_signal.store(0);
    handle_unless_ignored(SIGINT);
    handle_unless_ignored(SIGTERM);
}

StopOnSignal::~StopOnSignal() {
    restore_unless_ignored(SIGINT);
    restore_unless_ignored(SIGTERM);
}

const std::atomic<bool>& StopOnSignal::flag() const {
    return stop_requested;
}

int received_stop_signal() {
    return stop_signal.load();
}

void end_by_signal(int signal) {
    set_handler(signal, SIG_DFL);
    raise(signal);
}

}  // namespace obscura::app
