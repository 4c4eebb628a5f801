// python/module/turn.cpp - who may use a session, and the ends of sessions and assets.
// SPDX-License-Identifier: Apache-2.0
#include "session.h"
#include <chrono>
#include <new>
#include <sys/types.h>
#include <unistd.h>
#include <utility>

namespace obscura::python {

namespace {

/// The process in which the library was used first; 0: it was not.
std::atomic<pid_t> process = 0;

bool is_forked() {
    const pid_t first = process;
    return first != 0 && first != getpid();
}

/// In a forked process nothing of the library may run, not even what frees its memory: it would
/// wait for threads that are not there.
template <typename T>
void abandon(std::optional<T>& value) {
    if (value) new T(std::move(*value));
}

}  // namespace

SessionState::SessionState(py::object log_) : log(std::move(log_)) {
    session.emplace([this](const Message& message) {
        if (call != nullptr) call->post(message);
    });
}

SessionState::~SessionState() {
    if (is_forked()) abandon(session);
}

AssetState::~AssetState() {
    if (is_forked()) abandon(asset);
}

Turn::Turn(SessionState& state) : state_(state) {
    pid_t none = 0;
    process.compare_exchange_strong(none, getpid());
    if (is_forked()) {
        throw std::runtime_error(
            "obscura was used before this process was forked, and its threads are not here; start "
            "processes by multiprocessing's method 'spawn'");
    }
    if (state.owner == std::this_thread::get_id()) {
        throw std::runtime_error(
            "a callback may not use the session that calls it; take another session");
    }
    for (bool mine = false; !mine;) {
        {
            const py::gil_scoped_release released;
            mine = state.busy.try_lock_for(std::chrono::milliseconds(20));
        }
        if (!mine && PyErr_CheckSignals() != 0) throw py::error_already_set();
    }
    state.owner = std::this_thread::get_id();
    if (!state.is_closed) return;
    state.owner = std::thread::id();
    state.busy.unlock();
    throw py::value_error("the session is closed");
}

Turn::~Turn() {
    state_.owner = std::thread::id();
    state_.busy.unlock();
}

void close_asset(AssetState& state) {
    std::optional<Asset> asset;
    asset.swap(state.asset);
    const py::gil_scoped_release released;
    asset.reset();
}

}  // namespace obscura::python
