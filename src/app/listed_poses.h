// app/listed_poses.h - poses an asset for the images of a list, each pose once.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/render_job.h"

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace obscura::app {

/// The images of a command, and the asset as each of them shows it. Job::request is that of the
/// image that is begun.
class ListedPoses {
public:
    explicit ListedPoses(Job& job) : job_(job), whole_(job.request) {}

    /// What the whole command is asked for.
    const RenderRequest& whole() const { return whole_; }
    const ImageList& list() const { return list_; }

    /// Lists the images; reads the asset first where only that tells them.
    ///
    /// Errors  those of load_once and list_images
    Result<void> find_images(Log& log);

    /// Reads the asset and the environment, once for all images. After an error there is no
    /// Job::renderer.
    ///
    /// Errors  those of loading, of the environment too; 69 E-OIIO
    Result<void> load_once();

    /// Closes the asset; what comes next reads it again.
    void close();

    /// Adds what reading asset and environment has warned of to the log of a further image.
    void tell_again(Log& log);

    /// Makes the job's request that of an image.
    void begin_image(size_t index);

    /// Poses the asset for the image that is begun, unless it is posed so already. A sequence keeps
    /// the views of its first frame.
    ///
    /// In      is_last: no other pose will follow
    /// Errors  those of AssetRenderer::pose; 69 E-SEG-IDS
    Result<void> pose(size_t index, bool is_last, Log& log);

    /// The same, ready to be rendered.
    ///
    /// Errors  likewise, and those of AssetRenderer::prepare
    Result<ChosenCamera> look(size_t index, bool is_last, Log& log);

private:
    /// What each view keeps of a sequence's first frame.
    struct KeptView {
        Bounds bounds;
        Framing framing;
    };
    /// How the environment is turned, and how bright it is.
    using Light = std::pair<double, double>;

    bool is_sequence() const { return whole_.frames && whole_.frames->numbers.size() > 1; }
    AssetPose pose_of(size_t index) const;
    Result<void> load(Log& log);
    Result<void> open(Log& log);
    void take(KeptAsset&& asset, Log& log);
    Result<void> light(Log& log);
    Result<void> pose_as(const AssetPose& pose, bool is_last, Log& log);
    Result<void> pose_anew(const AssetPose& pose, bool is_last, Log& log);
    void keep_views(const std::string& variant);

    Job& job_;
    RenderRequest whole_;
    ImageList list_;
    std::optional<AssetPose> posed_;
    std::optional<Light> lit_;  ///< nothing: the pose has not been prepared
    std::map<std::string, std::vector<KeptView>> kept_;  ///< of a sequence, by variant
    bool notes_pose_ = false;     ///< what the next pose has to say belongs to Job::asset_notes
    bool has_told_pose_ = false;  ///< what posing has to say was told before
    bool is_reopened_ = false;    ///< what reading has to say was told before
    std::optional<RenderStatistics> before_close_;
};

/// Tells environments apart, whose colours are those of the rendering space; "": there is none.
std::string environment_key(const RenderRequest& request);

/// Leaves the asset to later renderings of a job that need it.
void leave_asset(Job& job);

/// Gives the memory back that later renderings would have used. False: there was none.
bool give_back(KeptForLater& kept);

}  // namespace obscura::app
