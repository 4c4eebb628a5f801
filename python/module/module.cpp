// python/module/module.cpp - the module obscura._obscura, which the package obscura shows.
// SPDX-License-Identifier: Apache-2.0
#include "call.h"
#include "session.h"
#include "settings.h"

PYBIND11_MODULE(_obscura, module) {
    using namespace obscura::python;
    module.attr("version") = obscura::version();
    bind_settings(module);
    bind_asset(module);
    bind_image(module);
    bind_session(module);
    py::module_::import("atexit").attr("register")(py::cpp_function(&Inside::end));
}
