// include/obscura/session.h - the library's door: opens assets, renders images, writes files.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "obscura/asset.h"
#include "obscura/control.h"
#include "obscura/error.h"
#include "obscura/image.h"
#include "obscura/view.h"
#include <memory>
#include <string>

OBSCURA_BEGIN_API

/// Renders as the program `obscura` does, with the same bits.
///
/// Prints nothing, throws nothing, handles no signals and changes no setting of the process or of
/// other libraries. A session and its assets are used by one thread
/// at a time; several sessions work side by side.
class OBSCURA_API Session {
public:
    /// sink: gets warnings and notes; empty: nobody wants them.
    explicit Session(MessageSink sink = {});
    ~Session();
    Session(Session&&) noexcept;
    Session& operator=(Session&&) noexcept;

    /// Reads and checks a .gltf or .glb file with everything that it refers to.
    Result<Asset> open(const std::string& file, const AssetOptions& options = {});

    /// Renders one image. The same arguments give the same bits for any number of threads.
    Result<Image> render(const Asset& asset,
                         const View& view,
                         const Look& look = {},
                         const Sampling& sampling = {},
                         const Control& control = {});

    /// Writes .exr, .png, .jpg, .tif, .webp or .avif: the file that the program writes, whole or
    /// not at all. Only an EXR has the layers; the other formats hold the beauty alone.
    Result<void> write(const Image& image,
                       const std::string& file,
                       const WriteOptions& options = {});

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

OBSCURA_END_API
