#pragma once
// Sessions whose frames are measured, and the truth that they are measured against.

#include "viewer/engine/render_session.h"

#include <memory>

namespace viewer {

/// A session with a scene. @param scene  file or name  @param settings  in order, before the scene
/// @param report  outlives it
std::unique_ptr<RenderSession> bench_session(std::string const& scene, std::vector<Change> const& settings,
                                             gi::Report& report);

/// The layer `color` of a view of the session's world as its last frame left it, by the method reference with as
/// many bounces as the session has. @param paths  per pixel; their noise is in it
gi::Layer reference_of(RenderSession const& session, ViewCommand const& view, int paths, gi::Report& report);

} // namespace viewer
