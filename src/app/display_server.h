// app/display_server.h - shows images in the viewer tev while they are being rendered.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/log.h"
#include "film/film.h"
#include "image/layers.h"
#include "render/render.h"
#include "session/render_request.h"

#include <memory>
#include <string>
#include <thread>

namespace obscura::app {

/// A viewer that is told of every image of a command. A thread of its own connects and sends, so
/// that rendering never waits for the network; where the viewer cannot be reached, or is lost,
/// there is one warning, and all else goes on.
class DisplayServer {
public:
    DisplayServer(const DisplayAddress& address, Log& log);
    ~DisplayServer();
    DisplayServer(const DisplayServer&) = delete;
    DisplayServer& operator=(const DisplayServer&) = delete;

    /// The image that what follows belongs to. An earlier one is still sent as far as it has come.
    void begin_image(const std::string& name);

    /// New pixels of the image; from any thread.
    void add(const FinishedTile& tile);
    void add(const Film& film, const PixelRect& area);
    /// All of its pixels, as files will have them.
    void add(const OutputImage& image);

    /// Nothing more comes: waits until everything is sent, but for a few seconds only.
    ///
    /// In      at_once: does not wait
    void finish(bool at_once);

private:
    struct Shared;

    /// What the thread does; it owns what it works with, as a look-up of a name cannot be ended.
    static void run(const std::shared_ptr<Shared>& shared);

    std::shared_ptr<Shared> shared_;
    std::thread thread_;
};

}  // namespace obscura::app
