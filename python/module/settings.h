// python/module/settings.h - the settings of the library by the names that Python gives them.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fields.h"

namespace obscura::python {

/// Control, with what it has to do with Python; null objects: nobody is asked and called.
struct RenderControl : Control {
    py::object cancel_event, on_progress, on_tile;
};

Fields<AssetOptions> asset_fields();
Fields<WriteOptions> write_fields();
Fields<RenderControl> control_fields();

/// Adds OpenCvCamera, View, Look and Sampling.
void bind_settings(py::module_& module);

}  // namespace obscura::python
