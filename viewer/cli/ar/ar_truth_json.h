#pragma once
// Errors against the ground truth as JSON.

#include "ar/runtime/frame_truth.h"

#include <nlohmann/json.hpp>

namespace viewer {

/// Median, 95 % quantile and maximum of each error, null where no frame has it; counts of frames.
nlohmann::ordered_json to_json(ar::FrameErrors const& errors);

} // namespace viewer
