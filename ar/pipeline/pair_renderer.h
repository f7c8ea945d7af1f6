#pragma once
// Renders a local scene with and without its virtual objects, for compositing.

#include "ar/pipeline/local_scene.h"
#include "ar/pipeline/pair_pictures.h"
#include "ar/pipeline/prefiltered/prefiltered_pairs.h"
#include "ar/scene/session_file.h"
#include "gi/core/report.h"
#include "gi/filter/denoise.h"
#include "gi/methods/names.h"
#include "gi/scene/motion/moving_world.h"

namespace ar {

class PairRenderer {
public:
    /// @param settings  size and number of paths are set per call of `render`
    /// @param method  with Method::pairs
    PairRenderer(LocalScene local, gi::RenderSettings const& settings, gi::Report& report,
                 std::string method = std::string(gi::kDefaultMethod));

    /// Sets the place's environment map; null: none.
    void set_environment(std::shared_ptr<gi::EnvironmentMap const> map);
    /// Chooses how to light, for the scenes as they are. Without a call: paths.
    /// @return why paths are used; empty = prefiltered light
    /// @throws gi::InputError prefiltered light is asked for and cannot light these scenes
    std::string choose(PairLight light);
    bool is_prefiltered() const { return prefiltered_; }
    /// @param paths, filter  not used by prefiltered light
    /// @param filter  for both pictures: equal pixels stay equal except near unequal ones. The a-trous filter
    ///                needs variances, and does nothing with one path
    PairPictures render(gi::Camera const& camera, int width, int height, std::uint32_t paths, gi::SceneTime time_s,
                        gi::DenoiseSettings filter, gi::StopRequest const& stop);
    gi::World const& world() const { return world_.world(); }
    /// Corners of the boxes around the virtual meshes, as they are placed at that time (of skins and morphs: at rest).
    std::vector<glm::dvec3> virtual_corners(gi::SceneTime time_s) const;
    /// The world with all virtual objects in place; valid until the next picture.
    gi::World const& world_with(gi::SceneTime time_s);

private:
    gi::Changes turn(gi::PairSide side, gi::SceneTime time_s);
    PairPictures prefiltered(gi::Camera const& camera, int width, int height, gi::SceneTime time_s,
                             gi::StopRequest const& stop);

    SceneChange change_since_last(gi::SceneTime time_s);

    LocalScene local_;
    std::string method_;
    gi::RenderSettings settings_;
    gi::Report& report_;
    gi::MovingWorld world_;
    std::vector<gi::Light> virtual_lights_; ///< the virtual lights, for the side with them
    gi::Changes pending_;                   ///< since the last picture
    std::unique_ptr<gi::FrameRenderer> frames_;
    bool light_changed_ = true;         ///< since the last picture
    std::optional<gi::Pose> last_pose_; ///< of the last picture
    bool prefiltered_ = false;
    std::unique_ptr<PrefilteredPairs> pairs_; ///< made for the first picture by prefiltered light
};

} // namespace ar
