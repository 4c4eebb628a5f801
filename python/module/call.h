// python/module/call.h - runs a call of the library while Python's signals and callbacks go on.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "convert.h"
#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <variant>

namespace obscura::python {

/// Pixels of a tile, copied: those of the library change after its callback.
struct TileCopy {
    Rect area;
    std::vector<std::string> channels;
    std::vector<float> pixels;
};

/// Who is called with what; null objects: nobody.
struct Listeners {
    py::object message, progress, tile;
    py::object cancel;  ///< with is_set(), which is asked every few hundredths of a second
};

/// True in a process that was forked after the library had been used: its threads stayed behind.
bool is_forked();

/// A thread that came from Python and uses the library. At the end of the interpreter such threads
/// are waited for, since Python would end them in the middle of C++.
class Inside {
public:
    /// Throws RuntimeError once the interpreter ends, and in a forked process.
    Inside();
    ~Inside();
    Inside(const Inside&) = delete;
    Inside& operator=(const Inside&) = delete;

    static bool is_ending();
    /// Stops what is under way and waits for its end. With the GIL.
    static void end();
};

/// One call of the library, on a thread of its own.
///
/// The thread that made the call waits for it without the GIL. It alone calls Python: callbacks run
/// where render() was called, as Python's own do, signals are handled meanwhile, and no thread of
/// the library ever has to do with the interpreter. An exception of a callback or of a signal's
/// handler sets `cancel`, and is thrown when the library has returned.
class Call {
public:
    /// Runs `work` to its end. With the GIL.
    void run(const std::function<void()>& work, const Listeners& listeners);

    std::atomic<bool> cancel = false;

    // For the threads of the library.
    void post(const Message& message);
    void post(const Tile& tile);
    void post_progress(double share);

private:
    using Event = std::variant<Message, TileCopy>;

    /// What has happened since it was asked last.
    struct Happened {
        std::deque<Event> events;
        std::optional<double> progress;
        bool finished = false;
    };

    Happened wait();
    void tell(Happened& happened, const Listeners& listeners);
    void stop();

    std::mutex mutex_;
    std::condition_variable changed_;
    Happened happened_;
};

}  // namespace obscura::python
