// session/outputs.h - the files that a rendering leaves: checked before, described, written after.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/render.h"
#include "session/render_request.h"
#include "session/segmentation.h"

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace obscura {

/// Standard output in messages.
inline constexpr const char* standard_output_name = "standard output";

/// All files of an image: pictures, layers in files of their own, masks with their JSON.
std::vector<std::filesystem::path> all_files(const RenderRequest& request,
                                             const ListedImage& image);

/// Finds early errors before the costly work starts: the files that a command writes beside its
/// images can be created, and standard output can hold what it is asked for.
///
/// Errors  64 E-OUT-FORMAT, E-USAGE-CONFLICT; 73 E-OUT-CREATE
Result<void> check_outputs(const RenderRequest& request);

/// The same for the files of images: every output can be created, every extension is known, and
/// every format can hold what it is asked for. Folders that names by pattern call for are made. One
/// image stands for all whose files lie in the same folders.
///
/// Errors  64 E-OUT-FORMAT, E-USAGE-CONFLICT; 73 E-OUT-CREATE. Of a list of images, where none can
///         be written
Result<void> check_image_files(const RenderRequest& request,
                               const std::vector<ListedImage>& images);

/// Begins to open the library that writes the outputs or reads the environment, where it takes its
/// time: beside what else there is to do.
void open_writers_ahead(const RenderRequest& request);

/// Finds out, before the costly work, whether what writes the outputs is there.
///
/// Errors  69 E-OIIO
Result<void> check_writers(const RenderRequest& request);

/// Warns of what a file could not keep.
void warn_of(const WriteReport& report, const std::string& file, Log& log);

/// Warns of files whose format has no alpha, when the image is transparent and no page lies behind
/// it: they show black there.
void warn_of_lost_alpha(const RenderRequest& request, Log& log);

/// The display transform, where an output of colours that is no EXR needs one.
///
/// Errors  78 E-OCIO-*
Result<std::optional<DisplayTransform>> make_display(const RenderRequest& request, Log& log);

/// Brightens or darkens the display by the camera's photographic exposure, if it has one.
///
/// Errors  78 E-OCIO-*
Result<void> expose_display(const ChosenCamera& chosen,
                            const RenderRequest& request,
                            std::optional<DisplayTransform>& display,
                            Log& log);

/// Metadata of an image's header.
ImageMetadata make_metadata(const RenderRequest& request,
                            const PreparedScene& prepared,
                            const ChosenCamera& chosen,
                            const Log& log);

/// Attributes that say what adaptive sampling was to reach and what it did.
void add_samples_taken(const AdaptiveOptions& asked,
                       const SamplesTaken& taken,
                       ImageMetadata& metadata);

/// The EXR attribute `obscura:degraded`: "textures=2 primitives=0 triangles=17".
std::string degraded_text(const gltf::Degraded& degraded);

/// The image and metadata that write_outputs puts into every file.
struct FinishedImage {
    OutputImage image;
    ImageMetadata metadata;
    std::string crypto_manifest = {};  ///< the text of the request's file; empty: there is none
    std::optional<Segmentation> segmentation = {};
    RenderCounters counters;
    double render_seconds = 0;
};

/// A file of an image in memory, as write_outputs writes it.
///
/// Errors  those of encode_image
Result<EncodedFile> encode_output(const RenderRequest& request,
                                  const FinishedImage& finished,
                                  const OutputTarget& target,
                                  const std::optional<DisplayTransform>& display);

/// Interleaved 8-bit codes: grey, RGB, or RGB and straight alpha.
struct DisplayedImage {
    int width = 0, height = 0, channels = 0;
    std::vector<uint8_t> codes;
};

/// What a PNG of an image shows, without the PNG.
DisplayedImage displayed_image(const RenderRequest& request,
                               const FinishedImage& finished,
                               const std::optional<DisplayTransform>& display);

/// Writes every output, each whole or not at all, standard output last; stops between two when a
/// signal came. Warns of what a file could not keep. A file that cannot be written is not lost: see
/// write_or_rescue.
///
/// Errors  those of write_image_file and write_or_rescue; 75 E-STOPPED
Result<void> write_outputs(const RenderRequest& request,
                           const FinishedImage& finished,
                           const std::optional<DisplayTransform>& display,
                           const std::atomic<bool>& stop,
                           Log& log);

}  // namespace obscura
