// examples/embed/embed.cpp - renders an asset from another program: ./embed shoe.glb shoe.exr.
// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <obscura/obscura.h>
#include <utility>

namespace {

template <typename T>
T or_exit(obscura::Result<T> result) {
    if (result) return std::move(*result);
    const obscura::Error& error = result.error();
    std::fprintf(
        stderr, "%s: %s [%s]\n", error.place.c_str(), error.text.c_str(), error.id.c_str());
    std::exit(error.code);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) return 64;
    obscura::Session session([](const obscura::Message& message) {
        if (message.is_warning)
            std::printf("%s: %s\n", message.place.c_str(), message.text.c_str());
    });
    obscura::Asset asset = or_exit(session.open(argv[1]));
    for (const obscura::CameraInfo& camera : asset.info().cameras)
        std::printf("camera '%s'\n", camera.name.c_str());

    obscura::View view;  // the file's first camera, else all of the asset
    view.width = 96;
    view.height = 64;
    obscura::Sampling sampling;
    sampling.samples_per_pixel = 4;
    sampling.aov = {"depth", "crypto_object"};
    std::atomic<bool> cancel{false};  // another thread may set it
    int tiles = 0;
    obscura::Control control;
    control.cancel = &cancel;
    control.tile = [&](const obscura::Tile&) { ++tiles; };
    obscura::Image image = or_exit(session.render(asset, view, {}, sampling, control));
    std::printf("%d tiles, %.2f s, red of the first pixel: %g\n",
                tiles,
                image.statistics.render_seconds,
                static_cast<double>(image.pixels[0]));
    for (const obscura::Layer& layer : image.layers)
        std::printf("layer %s: %zu channels\n", layer.name.c_str(), layer.channels.size());

    obscura::WriteOptions options;
    options.float32 = true;
    const obscura::Result<void> written = session.write(image, argv[2], options);
    if (!written) std::fprintf(stderr, "%s\n", written.error().text.c_str());
    return written ? 0 : written.error().code;
}
