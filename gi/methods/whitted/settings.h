#pragma once
// Settings of ray trees.

namespace gi {

/// Settings of ray trees: the method whitted and those that add indirect light to it, see gi/methods/whitted.
struct WhittedSettings {
    int recursion = 8;         ///< mirrors and glass along a ray tree; rays beyond are cut and counted
    float cutoff = 1.0f / 256; ///< rays that would contribute less than this share are cut and counted
    int light_samples = 4;     ///< shadow rays at a surface seen directly; in mirrors and glass one
};

} // namespace gi
