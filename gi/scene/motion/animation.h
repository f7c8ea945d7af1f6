#pragma once
// A scene's nodes at a moment: clips sampled, transforms multiplied down the graph.

#include "gi/scene/model/scene.h"

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

/// Add `weight` times the morph weights of a fractional frame (ChannelPath::morph_frame) to `morph`, one per
/// target.
void add_frame(double frame, double weight, std::vector<double>& morph);

/// Local time of a playback, s.
double local_time(Playback const& playback, double duration_s, double time_s);

/// Without a time the nodes rest as the file has them. Several clips that move one part of a node are blended
/// (Playback): translations, scales and morph weights linearly; rotations by the normalised weighted sum of their
/// quaternions in the hemisphere of the first. Unlike repeated slerp that sum does not depend on the order of more
/// than two clips, never vanishes and costs no trigonometry; two rotations 90 degrees apart are blended within 1
/// degree of slerp, 180 degrees apart within 9.
Pose evaluate_pose(Scene const& scene, std::optional<double> time_s);

} // namespace gi
