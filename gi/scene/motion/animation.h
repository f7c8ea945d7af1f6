#pragma once
// Pose of a scene's nodes at one time: clips are sampled and transforms multiplied down the node graph.

#include "gi/scene/model/scene.h"

#include <optional>
#include <vector>

namespace gi {

/// Transforms and morph weights of a scene's nodes at one time.
struct Pose {
    std::vector<dmat4> world_from_node;            ///< one per node
    std::vector<std::vector<float>> morph_weights; ///< one per node, empty = none
};

/// Samples a channel at a time (s), clamped to its first and last key (glTF 2, appendix C), and writes `count`
/// numbers to `out`. Rotations are written as unit quaternions x, y, z, w.
void sample_channel(AnimationChannel const& channel, double time_s, std::size_t count, float* out);

/// Adds `weight` times the morph weights of a fractional frame (ChannelPath::morph_frame) to `morph`, which has
/// one entry per target.
void add_frame(double frame, double weight, std::vector<double>& morph);

/// Returns the local time of a playback, s.
double local_time(Playback const& playback, double duration_s, double time_s);

/// Evaluates the pose; without a time, nodes are in the rest pose of the file. Several clips that move one part of
/// a node are blended (Playback): translations, scales and morph weights linearly; rotations by the normalised
/// weighted sum of their quaternions in the hemisphere of the first. Unlike repeated slerp, this sum does not
/// depend on the order of more than two clips, never vanishes and needs no trigonometry; two rotations 90 degrees
/// apart are blended within 1 degree of slerp, 180 degrees apart within 9.
Pose evaluate_pose(Scene const& scene, std::optional<double> time_s);

} // namespace gi
