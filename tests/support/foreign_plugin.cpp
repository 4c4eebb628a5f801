// tests/support/foreign_plugin.cpp - a library that reports when a process loads it.
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

namespace {

struct Announcement {
    Announcement() { std::fputs("foreign code runs\n", stderr); }
};

const Announcement announcement;

}  // namespace
