// serve/beside.h - a thread beside another one's work.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "serve/guarded.h"
#include <atomic>
#include <functional>
#include <thread>

namespace obscura::serve {

/// A thread that works while this lives; it is told when it is over. Its exceptions end it alone.
class Beside {
public:
    explicit Beside(const std::function<void(const std::atomic<bool>& is_over)>& work)
        : thread_([this, work] {
              const Result<void> done = guarded<void>([&]() -> Result<void> {
                  work(is_over_);
                  return {};
              });
              static_cast<void>(done);
          }) {}
    ~Beside() {
        is_over_ = true;
        thread_.join();
    }
    Beside(const Beside&) = delete;
    Beside& operator=(const Beside&) = delete;

private:
    std::atomic<bool> is_over_ = false;
    std::thread thread_;
};

}  // namespace obscura::serve
