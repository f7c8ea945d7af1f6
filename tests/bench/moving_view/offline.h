#pragma once
#include "tests/bench/moving_view/score.h"
#include "viewer/engine/render_session.h"

namespace viewer {

/// Frames at a fixed rate, each for its own moment or shown later, with light and surfaces at fixed scales.
void render_offline(Options const& o, RenderSession& session, Walk& walk, std::vector<Seen>& seen);

} // namespace viewer
