// python/module/turn.cpp - who may use a session, and the ends of sessions and assets.
// SPDX-License-Identifier: Apache-2.0
#include "session.h"
#include <chrono>
#include <stdexcept>
#include <utility>

namespace obscura::python {

namespace {

/// In a forked process nothing of the library may run, not even what frees its memory: it would
/// wait for threads that are not there.
template <typename T>
void abandon(std::optional<T>& value) {
    if (value) new T(std::move(*value));
}

/// The error of a rendering that was stopped, as the library has it.
const Error stopped = {"E-STOPPED", "render", "stopped on request", 75, {}};

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

Turn::Turn(SessionState& state, const py::object& cancel) : state_(state) {
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
        if (!mine && Inside::is_ending()) throw std::runtime_error("Python is ending");
        if (!mine && cancel && cancel.attr("is_set")().cast<bool>()) raise(stopped);
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
