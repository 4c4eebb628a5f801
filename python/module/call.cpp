// python/module/call.cpp - runs a call of the library while Python's signals and callbacks go on.
// SPDX-License-Identifier: Apache-2.0
#include "call.h"

#include <chrono>
#include <exception>
#include <stdexcept>
#include <sys/types.h>
#include <thread>
#include <unistd.h>
#include <utility>

namespace obscura::python {

namespace {

/// How long Ctrl-C and the event of a cancel wait at most.
constexpr std::chrono::milliseconds pause{20};

/// Tiles that wait for Python; more make the library wait, so that a slow callback takes no memory.
constexpr std::size_t max_waiting = 64;

/// The process in which the library was used first; 0: it was not.
std::atomic<pid_t> process = 0;

std::atomic<bool> ending = false;
std::atomic<int> threads_inside = 0;

}  // namespace

bool is_forked() {
    const pid_t first = process;
    return first != 0 && first != getpid();
}

Inside::Inside() {
    pid_t none = 0;
    process.compare_exchange_strong(none, getpid());
    if (is_forked()) {
        throw std::runtime_error(
            "obscura was used before this process was forked, and its threads are not here; start "
            "processes by multiprocessing's method 'spawn'");
    }
    if (ending) throw std::runtime_error("Python is ending");
    ++threads_inside;
}

Inside::~Inside() {
    --threads_inside;
}

bool Inside::is_ending() {
    return ending;
}

void Inside::end() {
    if (is_forked()) return;
    const py::gil_scoped_release released;
    ending = true;
    while (threads_inside > 0)
        std::this_thread::sleep_for(pause);
}

void Call::post(const Message& message) {
    {
        const std::lock_guard lock(mutex_);
        happened_.events.emplace_back(message);
    }
    changed_.notify_all();
}

void Call::post(const Tile& tile) {
    TileCopy copy{tile.area, tile.channels, {}};
    const auto row = static_cast<std::size_t>(tile.area.width) * tile.channels.size();
    copy.pixels.reserve(row * static_cast<std::size_t>(tile.area.height));
    for (int y = 0; y < tile.area.height; ++y) {
        const float* const first = tile.pixels + static_cast<std::size_t>(y) * tile.row_floats;
        copy.pixels.insert(copy.pixels.end(), first, first + row);
    }
    {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return happened_.events.size() < max_waiting || cancel; });
        if (cancel) return;
        happened_.events.emplace_back(std::move(copy));
    }
    changed_.notify_all();
}

void Call::post_progress(double share) {
    {
        const std::lock_guard lock(mutex_);
        happened_.progress = share;
    }
    changed_.notify_all();
}

void Call::stop() {
    {
        const std::lock_guard lock(mutex_);
        cancel = true;
    }
    changed_.notify_all();
}

Call::Happened Call::wait() {
    const py::gil_scoped_release released;
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, pause, [&] {
        return happened_.finished || happened_.progress || !happened_.events.empty();
    });
    Happened out = std::move(happened_);
    happened_ = {};
    happened_.finished = out.finished;
    lock.unlock();
    changed_.notify_all();
    return out;
}

void Call::tell(Happened& happened, const Listeners& listeners) {
    for (Event& event : happened.events) {
        if (const auto* message = std::get_if<Message>(&event)) {
            if (listeners.message) listeners.message(*message);
        } else {
            const auto tile = std::make_shared<TileCopy>(std::move(std::get<TileCopy>(event)));
            if (listeners.tile) listeners.tile(tile);
        }
    }
    if (happened.progress && listeners.progress) listeners.progress(*happened.progress);
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (listeners.cancel && listeners.cancel.attr("is_set")().cast<bool>()) stop();
}

void Call::run(const std::function<void()>& work, const Listeners& listeners) {
    std::exception_ptr of_work, of_python;
    std::thread worker([&] {
        try {
            work();
        } catch (...) {
            of_work = std::current_exception();
        }
        {
            const std::lock_guard lock(mutex_);
            happened_.finished = true;
        }
        changed_.notify_all();
    });
    for (bool finished = false; !finished;) {
        Happened happened = wait();
        finished = happened.finished;
        if (Inside::is_ending()) stop();
        if (of_python) continue;
        try {
            tell(happened, listeners);
        } catch (...) {
            of_python = std::current_exception();
            stop();
        }
    }
    worker.join();
    if (of_python) std::rethrow_exception(of_python);
    if (of_work) std::rethrow_exception(of_work);
}

}  // namespace obscura::python
