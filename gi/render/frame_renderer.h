#pragma once
// Frames of a world that moves, one after another. What did not change since the frame before is kept.

#include "gi/render/accumulator.h"
#include "gi/render/render_settings.h"
#include "gi/scene/motion/moving_world.h"

#include <memory>
#include <span>

namespace gi {

/// What there is at one moment while the shutter is open.
struct Moment {
    Changes changes; ///< of the world, since the moment before
    Camera camera;
};
/// Takes the world to the moment of a pass, counted from 0 in every frame.
using Moments = std::function<Moment(std::uint32_t pass)>;

/// One of several pictures of the same moment: an eye, a wall.
struct FrameView {
    Camera camera;
    int width = 0, height = 0; ///< pixels
    int partner = -1; ///< index of an earlier view that sees nearly the same: where it is valid, light that was
                      ///< found there may be taken over; -1 = none
    /// 1 per pixel that nobody sees, rows from the top; empty = none. Outlives the call. Their pictures are black
    /// there and have no surface. The method slhb traces nothing for them; others render them like all, and hide
    /// them in the end.
    std::span<std::uint8_t const> hidden{};
};

/// What is found of the light that surfaces send on to others.
enum class VertexSharing : std::uint8_t {
    none,  ///< each path finds it by itself: one that meets nothing new stays as it was, whatever others meet
    exact, ///< paths that end on one layer share it
    cached ///< paths may end in cells of a cache that is kept while light and geometry stay: much less work, a
           ///< little blur
};

/// The two pictures of a PairResult.
enum class PairSide : std::uint8_t { with, without };
/// Takes the world to one of them.
using PairWorld = std::function<Changes(PairSide)>;
/// What they differ in.
enum class PairDifference : std::uint8_t {
    anything,  ///< what PairWorld says; both are rendered whole
    vanishing, ///< without, nothing of what can move is there, and all else is the same
};
struct PairSettings {
    std::uint32_t paths = 1; ///< per pixel of each, >= 1
    PairDifference difference = PairDifference::anything;
    PictureLayers layers = PictureLayers::all;
};

/// Two pictures of one moment, of worlds that differ in what moves alone, by the same axes, points on lamps and
/// random numbers: paths that meet no difference are equal in every bit.
struct PairResult {
    RenderResult with, without;
    std::vector<float> coverage; ///< per pixel: share of the paths of `with` whose first surface is one that moves
    std::vector<vec3> covered;   ///< radiance that those paths bring to the pixel: no more than all of it
};

/// Makes all layers 0 in hidden pixels; "motion" is left as it is, since it is not read where nothing is seen.
/// @param hidden  as FrameView has it
void hide_pixels(Picture& picture, std::span<std::uint8_t const> hidden);

/// Directions kept for each bounce, and those that followed what moves in a frame.
struct DynamicUpdate {
    int stored = 0;     ///< all of them; 0 = none are kept
    int axes = 0;       ///< different ones that followed, of all bounces
    int bounces = 1;    ///< that choose theirs by themselves
    double seconds = 0; ///< that it took
};

class FrameRenderer {
public:
    virtual ~FrameRenderer() = default;

    /// The world has changed; before the next frame.
    virtual void changed(Changes const& changes) = 0;
    /// From the next frame on: of the directions kept for each bounce (method slhb, schedule stored) about so many
    /// follow what moves, others from frame to frame, and paths take no others; 0 = all. Methods that keep none
    /// have nothing to do.
    virtual void update_axes(int axes);
    /// What that came to in the last frame.
    virtual DynamicUpdate dynamic_update() const { return {}; }
    /// Renders what the camera sees now, with the budget and paths of the settings for every frame. Layers as
    /// those of RenderResult and, where the method knows it, "motion" (see gi/render/motion.h).
    /// @param moments  where given, every path of a pixel is of a moment of its own, so that their mean is blurred
    /// by
    ///                 motion; `camera` is then that of no path, and there is no "motion"
    virtual RenderResult frame(Camera const& camera, StopRequest const& stop, RenderProgress const& progress,
                               Moments const& moments = {}) = 0;
    /// Renders all views of one moment; what does not depend on the point of view is done once for all of them.
    /// Budget, paths and size of the settings do not count here; hidden pixels do here alone.
    /// @param paths  per pixel, >= 1
    /// @return a result per view, in their order; `interrupted` where `stop` came first, with fewer paths
    virtual std::vector<RenderResult> views(std::span<FrameView const> views, std::uint32_t paths,
                                            VertexSharing sharing, StopRequest const& stop) = 0;
    /// One view with what moves and without it; `turn` is asked for the one and the other in turns, `with` first,
    /// and leaves the world at either. Where things only vanish, the world stays at `with` if it can, and of the
    /// other picture only those paths are traced that what moves could change; bounds of the world, and with them
    /// the choice of lamps, are those of `with` in both.
    /// @throws InputError where the method does not know how
    virtual PairResult pair(FrameView const& view, PairSettings const& settings, PairWorld const& turn,
                            StopRequest const& stop);
};

/// Starts with the world as it is; it and the report outlive the renderer.
using StartFrames = std::unique_ptr<FrameRenderer> (*)(MovingWorld const&, Camera const&, RenderSettings const&,
                                                       Report&);

} // namespace gi
