// gltf/parse/document_buffers.h - reads buffers, buffer views and accessors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gltf/parse/document_reading.h"

namespace obscura::gltf {

/// The buffers' URIs and lengths are in the document already.
void read_buffers(DocumentReading& reading);
void read_views(DocumentReading& reading);
void read_accessors(DocumentReading& reading);

}  // namespace obscura::gltf
