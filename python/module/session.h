// python/module/session.h - sessions and assets as Python holds them.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "call.h"
#include <memory>
#include <mutex>
#include <thread>

namespace obscura::python {

struct AssetState;

/// A session, which lives as long as Python holds it or one of its assets.
struct SessionState {
    explicit SessionState(py::object log);
    ~SessionState();

    std::optional<Session> session;
    py::object log;  ///< called with messages; null: nobody
    bool is_closed = false;
    std::vector<std::weak_ptr<AssetState>> assets;

    std::timed_mutex busy;  ///< held by the thread whose call is under way
    std::atomic<std::thread::id> owner{};
    Call* call = nullptr;  ///< that is under way
};

struct AssetState {
    AssetState(std::shared_ptr<SessionState> of, Asset opened)
        : session(std::move(of)), asset(std::move(opened)), info(asset->info()) {}
    ~AssetState();

    std::shared_ptr<SessionState> session;
    std::optional<Asset> asset;  ///< none: it was closed
    AssetInfo info;
    std::optional<std::vector<NodeInfo>> nodes;  ///< once they were asked for
};

/// The turn of this thread to use a session: others wait for its end, without the GIL. Throws
/// RuntimeError where waiting would have no end: in a callback of the session's own call, and in a
/// process that was forked after the library had been used, whose threads stayed behind.
class Turn {
public:
    /// In      cancel: a threading.Event that ends the waiting, too; null: none
    explicit Turn(SessionState& state, const py::object& cancel = {});
    ~Turn();
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

private:
    const Inside inside_;
    SessionState& state_;
};

/// Throws an obscura.Error.
[[noreturn]] void raise(const Error& error);

/// Adds Session, Message and Tile.
void bind_session(py::module_& module);

/// Adds Asset and what its info consists of.
void bind_asset(py::module_& module);

/// Adds Image, Layer and Statistics.
void bind_image(py::module_& module);

/// Changes an asset in a turn of its own; throws what is wrong.
void change_asset(AssetState& state, const std::function<Result<void>(Asset&)>& made);

/// Frees what an asset holds; it is the turn of this thread.
void close_asset(AssetState& state);

}  // namespace obscura::python
