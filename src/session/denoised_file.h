// session/denoised_file.h - denoises an image whose file holds what denoising needs.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "base/error.h"
#include "base/log.h"
#include "image/exr_document.h"
#include "session/outputs.h"

#include <optional>
#include <string>

namespace obscura {

/// A denoised image: as a file like the one it came from, and as what other formats hold.
struct DenoisedFile {
    EncodedFile exr;
    FinishedImage finished;  ///< the beauty alone, with its origin
    std::string space;       ///< of its colours, as --color-space calls it; empty: not known
    std::optional<double> ev100 = {};
    std::string done;  ///< the attribute obscura:denoise
};

/// The files of the frames one before and one after; null where there is none.
struct NeighborDocuments {
    const ExrDocument* before = nullptr;
    const ExrDocument* after = nullptr;
};

/// Denoises the beauty of a file of `obscura render`, and the layers of the light in it, as
/// `render --denoise` does: where the file has the beauty, its halves and their guides in 32 bits,
/// to the same bits. All else in the file stays as it is; see ExrDocument::with_changes. Guides
/// that are missing are done without, with a warning. Neighbouring frames help where the layer
/// `motion` tells what they show of the same surfaces; where there is none, or it does not tell of
/// the camera's motion, they do not, with a warning.
///
/// In      keep_noisy: adds the beauty as it was as the layer `noisy`
/// Errors  65 E-DENOISE-SOURCE, also for a neighbour of another size, place, integrator or colour
///         space, or with other layers of the light; E-DENOISE-LAYER, also for one that lacks what
///         this one has; E-DENOISE-DONE, E-DENOISE-HALVES; E-EXR-CORRUPT, also for pixels that
///         are not finite; 64 E-USAGE-CONFLICT a layer is called `noisy`; those of ExrDocument
Result<DenoisedFile> denoise_document(const ExrDocument& document,
                                      const NeighborDocuments& neighbors,
                                      bool keep_noisy,
                                      Log& log);

}  // namespace obscura
