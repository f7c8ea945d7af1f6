#pragma once
// Methods whose pictures are sums of passes of one path per pixel: what such a method implements, and its single
// pictures and frame sequences, which are the same for all of them.

#include "gi/render/accumulator.h"
#include "gi/render/frame_renderer.h"
#include "gi/render/motion.h"

#include <functional>
#include <memory>

namespace gi {

class PassRenderer {
public:
    virtual ~PassRenderer() = default;
    /// See Changes.
    virtual void changed(Changes const& changes) = 0;
    /// Does before the next pass what need not count as time of passes, from which the loop foretells their end.
    /// @param index, views  of that pass  @param stop  as of pass()
    virtual void begin(std::uint32_t /*index*/, std::span<FrameView const> /*views*/, StopRequest const* /*stop*/)
    {
    }
    /// Traces one more path for every pixel of all views. @param index  of the pass, over all frames
    /// @param sums  one per view  @param motion  gets the first hits of all views; null = not needed
    /// @param stop  throws Interrupted, and the sums keep what they have (see TiledPass); null = never
    virtual void pass(std::uint32_t index, std::span<FrameView const> views, std::span<Accumulator> sums,
                      MotionVectors* motion, StopRequest const* stop) = 0;
    /// Reports the work done since the last call.
    virtual void report_work() = 0;
    /// Number of closest-hit and shadow rays so far.
    virtual double rays() const = 0;
    /// The chosen settings, as command-line options that reproduce the picture.
    virtual std::string options() const = 0;
    /// The same before the first pass, which may choose numbers by the time that is left.
    virtual std::string asked_options() const { return options(); }
};

/// Makes the renderer of a world. All arguments must outlive it, and the world's arrays must not be reallocated.
/// @param first_moving  index of the first triangle that may move
/// @param stop  of the only picture: checked while structures are built before the first pass, which throws
///   Interrupted; null = the passes belong to frames
using StartPasses = std::function<std::unique_ptr<PassRenderer>(
    World const&, RenderSettings const&, std::size_t first_moving, Report&, StopRequest const* stop)>;

/// StartPasses of a class whose constructor takes these arguments.
template <class Renderer>
std::unique_ptr<PassRenderer> start_passes(World const& world, RenderSettings const& settings,
                                           std::size_t first_moving, Report& report, StopRequest const* stop)
{
    return std::make_unique<Renderer>(world, settings, first_moving, report, stop);
}

/// Renders one picture. Layers: see RenderResult. The same seed gives the same bits for any number of threads, if
/// the passes do. @param name  of the method, for checkpoints. Throws InputError if the checkpoint does not fit.
RenderResult render_passes(char const* name, StartPasses const& start, World const& world, Camera const& camera,
                           RenderSettings const& settings, StopRequest const& stop, RenderProgress const& progress,
                           Report& report);

/// See StartFrames.
std::unique_ptr<FrameRenderer> start_pass_frames(StartPasses const& start, MovingWorld const& world,
                                                 RenderSettings const& settings, Report& report);

} // namespace gi
