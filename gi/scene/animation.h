#pragma once
// A scene's nodes at a moment: clips sampled, transforms multiplied down the graph.

#include "gi/scene/scene.h"

#include <optional>
#include <vector>

namespace gi {

/// What the nodes of a scene look like at one time.
struct Pose {
    std::vector<dmat4> world_from_node;            ///< one per node
    std::vector<std::vector<float>> morph_weights; ///< one per node, empty = none
};

/// The value of a channel at a time (s), held before its first and after its last key (glTF 2, appendix C):
/// `count` numbers per key into `out`. Rotations come out as unit quaternions x, y, z, w.
void sample_channel(AnimationChannel const& channel, double time_s, std::size_t count, float* out);

/// Local time of a playback, s.
double local_time(Playback const& playback, double duration_s, double time_s);

/// Without a time the nodes rest as the file has them.
Pose evaluate_pose(Scene const& scene, std::optional<double> time_s);

} // namespace gi
