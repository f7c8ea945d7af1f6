#pragma once
// Renders successive frames of a world that moves. Structures that did not change
// since the previous frame are kept.

#include "gi/render/accumulator.h"
#include "gi/render/render_settings.h"
#include "gi/scene/motion/moving_world.h"

#include <memory>
#include <optional>
#include <span>

namespace gi {

/// State of the scene at one moment while the shutter is open.
struct Moment {
    Changes changes; ///< of the world, since the previous moment
    Camera camera;
    /// The camera at a fraction, [0, 1), of the time that the shutter is open. Empty if anything else moves meanwhile.
    std::function<Camera(double)> camera_at{};
};
/// Callback that moves the world to the moment of a pass (counted from 0 in every frame).
using Moments = std::function<Moment(std::uint32_t pass)>;

/// One of several pictures of the same moment, such as an eye or a wall.
struct FrameView {
    Camera camera;
    int width = 0, height = 0; ///< pixels
    int partner = -1; ///< index of an earlier view that sees nearly the same; light computed there may be reused
                      ///< where it is valid; -1 = none
    /// 1 for each pixel that is never seen, rows from the top; empty = all are seen. Must outlive the call.
    /// Hidden pixels are black and have no surface. Some methods trace nothing for them;
    /// others render and then hide them.
    std::span<std::uint8_t const> hidden{};
    /// Instead of the settings' filter, where the method can.
    std::optional<PixelFilter> filter{};
    /// The camera at other moments of the exposure, of a world that stands still. Must outlive the call. Only
    /// `paths_layered_lens` gathers from them; for others the pass has one moment, that of `camera`.
    std::span<Camera const> during{};
};

/// How indirect light at a path's last vertex is shared between paths.
enum class VertexSharing : std::uint8_t {
    /// Each path computes its own, so that a path that hits no changed geometry keeps
    /// its value whatever other paths hit.
    none,
    exact, ///< paths that end on the same layer share it
    cached ///< paths may end in cells of a radiance cache that is kept while light and geometry are unchanged:
           ///< much less work, a little blur
};

/// The two pictures of a PairResult.
enum class PairSide : std::uint8_t { with, without };
/// Callback that switches the world to one of the two pictures.
using PairWorld = std::function<Changes(PairSide)>;
/// How the two worlds differ.
enum class PairDifference : std::uint8_t {
    anything,  ///< any change that PairWorld reports; both pictures are rendered in full
    vanishing, ///< `without` lacks all geometry that can move; everything else is the same
};
struct PairSettings {
    std::uint32_t paths = 1; ///< per pixel of each, >= 1
    PairDifference difference = PairDifference::anything;
    PictureLayers layers = PictureLayers::all;
};

/// Two pictures of one moment, of worlds that differ only in dynamic geometry, rendered with the same axes, light
/// samples and random numbers: paths unaffected by the difference are equal bit for bit.
struct PairResult {
    RenderResult with, without;
    std::vector<float> coverage; ///< per pixel: fraction of the paths of `with` whose first surface is dynamic
    /// Radiance that those paths contribute to the pixel, at most its total radiance.
    std::vector<vec3> covered;
};

/// Sets all layers to 0 in hidden pixels, except "motion", which is not read where no surface is seen.
/// @param hidden  as in FrameView
void hide_pixels(Picture& picture, std::span<std::uint8_t const> hidden);

/// Number of axes stored per bounce, and of those updated for dynamic geometry in a frame.
struct DynamicUpdate {
    int stored = 0;     ///< stored axes; 0 = none
    int axes = 0;       ///< distinct axes updated, over all bounces
    int bounces = 1;    ///< bounces that choose their axes separately
    double seconds = 0; ///< duration of the update
};

class FrameRenderer {
public:
    virtual ~FrameRenderer() = default;

    /// Call before the next frame if the world has changed.
    virtual void changed(Changes const& changes) = 0;
    /// Renders a frame; the settings' budget and paths apply to each frame. The layers are those of RenderResult
    /// and, if the method supports it, "motion" (see gi/render/motion.h).
    /// @param moments  if set, every path of a pixel is traced at its own moment, so that their mean is motion
    ///   blurred; `camera` is then not used for paths, and there is no "motion"
    virtual RenderResult frame(Camera const& camera, StopRequest const& stop, RenderProgress const& progress,
                               Moments const& moments = {}) = 0;
    /// Renders all views of one moment; view-independent work is done once for all of them. Ignores budget, paths
    /// and size of the settings. Only this function supports hidden pixels.
    /// @param paths  per pixel, >= 1
    /// @return one result per view, in order; `interrupted`, with fewer paths,
    ///   if `stop` was requested before the end
    virtual std::vector<RenderResult> views(std::span<FrameView const> views, std::uint32_t paths,
                                            VertexSharing sharing, StopRequest const& stop) = 0;
};

/// What only some renderers of frames can do; ask<FollowingAxes>(renderer) is null for the others.
template <class Ability>
Ability* ask(FrameRenderer& renderer)
{
    return dynamic_cast<Ability*>(&renderer);
}

/// Takes options over from one frame to the next that need no new renderer (RenderOption::restarts).
class LiveSettings {
public:
    virtual ~LiveSettings() = default;
    virtual void follow(RenderSettings const& settings) = 0;
};

/// Paths share stored axes, whose hit buffers follow dynamic geometry.
class FollowingAxes {
public:
    virtual ~FollowingAxes() = default;
    /// From the next frame on: update about `axes` stored axes per bounce each frame, round-robin; paths sample only
    /// the updated ones; 0 = all.
    virtual void update_axes(int axes) = 0;
    /// Returns the counts of the last frame's update.
    virtual DynamicUpdate dynamic_update() const = 0;
};

class PunctualLeftOut {
public:
    virtual ~PunctualLeftOut() = default;
    /// From the next frame on: leave out, of L1, the light of punctual lights on the surfaces that views show, also
    /// in mirrors and panes (gi/scene/shading/seen_mirror.h), because the caller adds it.
    virtual void leave_out_punctual(bool on) = 0;
};

/// Frames that can be undone.
class FramesGivenUp {
public:
    virtual ~FramesGivenUp() = default;
    /// In the next call of `views`, a stop ends the frame within milliseconds: it throws Interrupted, and all is as if
    /// the call had not been made. Costs a copy of what that frame teaches later ones; if that is larger than
    /// 256 MiB, or the frame looks up layers, it cannot be undone, and a stop shortens it.
    virtual void may_give_up() = 0;
    /// Whether the last frame, which may_give_up() announced, can be undone. Ask before anything else is called.
    virtual bool can_undo() const = 0;
    /// Makes all as it was before the last frame, but for what was reported. Only if can_undo().
    virtual void undo() = 0;
    /// The last frame stays: frees what undo() would need.
    virtual void keep() = 0;
};

class PairFrames {
public:
    virtual ~PairFrames() = default;
    /// Renders one view with and without the dynamic geometry.
    /// Calls `turn` for the two sides alternately, `with` first, and leaves the world at either side.
    /// With PairDifference::vanishing the world stays at `with` if possible, light samples are tested by shadow
    /// maps, which show what dynamic geometry may affect, and of the other picture only those paths are traced;
    /// the bounds of the world, and so the choice of lights, are those of `with` in both.
    virtual PairResult pair(FrameView const& view, PairSettings const& settings, PairWorld const& turn,
                            StopRequest const& stop) = 0;
};

/// Makes a renderer for the current state of the world; the world and the report must outlive it.
using StartFrames = std::unique_ptr<FrameRenderer> (*)(MovingWorld const&, Camera const&, RenderSettings const&,
                                                       Report&);

} // namespace gi
