#pragma once
// Render sessions whose frames are measured, and references to compare with.

#include "viewer/engine/render_session.h"

#include <memory>

namespace viewer {

/// Returns a render session with a scene. @param scene  file or name  @param settings  applied in order, before
/// the scene  @param report  must outlive the session
std::unique_ptr<RenderSession> bench_session(std::string const& scene, std::vector<Change> const& settings,
                                             gi::Report& report);

/// Layer `color` of a view of the session's world after its last frame, rendered by method reference with the
/// session's number of bounces. @param paths  per pixel; the result contains their noise
gi::Layer reference_of(RenderSession const& session, ViewCommand const& view, int paths, gi::Report& report);

} // namespace viewer
