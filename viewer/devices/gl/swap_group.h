#pragma once
// Swap groups of the driver (GLX_NV_swap_group): windows of a group swap at the same refresh, and groups at the
// same barrier do so on several machines.

#include <string>

namespace viewer {

/// Joins the current drawable to a group, and the group to a barrier if that
/// is > 0. A GLX context must be current.
/// @return  why it failed; empty = joined
std::string join_swap_group(int group, int barrier);

} // namespace viewer
