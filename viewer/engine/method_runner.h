#pragma once
// Runs one light-transport method on the frames of a render session, with its temporal reuse and filter.

#include "gi/filter/fireflies.h"
#include "gi/filter/temporal.h"
#include "gi/methods/registry.h"
#include "gi/surfaces/lit_picture.h"
#include "viewer/engine/hidden_views.h"
#include "viewer/engine/scene_start.h"
#include "viewer/engine/settings.h"

#include <memory>

namespace viewer {

/// Classifies the changes between two frames for temporal reuse.
gi::SceneChange scene_change(gi::Changes const& changes, bool camera_moved);

/// What becomes of a frame that is stopped.
enum class OnStop : bool {
    shorten, ///< it has fewer paths, at least one
    give_up, ///< if nothing changed in the scene, and if the method can (gi::FramesGivenUp), it throws Interrupted, and
             ///< all is as if it had never begun, also while it is filtered; else as `shorten`
};

class MethodRunner {
public:
    /// The world and the report must outlive it. @param start  what the plan is made for
    /// @param ahead  the world may change before the first frame
    MethodRunner(std::string const& method, gi::MovingWorld const& world, Settings const& settings, int threads,
                 SceneStart const& start, gi::Report& report, bool ahead = false);

    /// Returns one picture per view. @param hidden  per view  @param changes  of the world since the last frame
    /// @param seen  surfaces of the world; null = not needed
    /// @param leaves_out_punctual  as gi::FrameRenderer::leave_out_punctual, if the method can
    /// @param around  a further view, for light_around(); width 0 = none
    std::vector<gi::RenderResult> render(FrameCommand const& command, std::span<HiddenPixels const> hidden,
                                         gi::Changes const& changes, Settings const& settings,
                                         gi::SeenSurfaces* seen, bool leaves_out_punctual,
                                         gi::StopRequest const& stop, OnStop on_stop,
                                         gi::FrameView const& around = {});
    /// The last frame lacks the light of punctual lights.
    bool left_out_punctual() const { return left_out_punctual_; }
    /// Light of a view of the last frame; null without `seen`.
    gi::KeptLight const* light(std::size_t view) const { return state_.seen[view].light.get(); }
    /// Its pixels that show images in mirrors and glass.
    std::span<gi::SeenImage const> images(std::size_t view) const { return images_[view]; }
    /// Unfiltered light of the further view of the last frame; empty without.
    gi::LightPicture const& light_around() const { return around_; }
    int still_frames() const { return state_.still; }
    /// For a method that chooses another: which and why, a sentence; else empty.
    std::string const& choice() const { return choice_; }
    gi::DynamicUpdate dynamic_update() const ///< of the last frame
    {
        auto const* const axes = gi::ask<gi::FollowingAxes>(*renderer_);
        return axes != nullptr ? axes->dynamic_update() : gi::DynamicUpdate{};
    }

private:
    struct Seen { ///< state kept for a view
        std::string name;
        gi::Camera camera;
        int width = 0, height = 0;
        std::shared_ptr<gi::TemporalReuse> reuse;
        int most_frames = 0;
        HiddenPixels hidden;
        std::shared_ptr<gi::KeptLight const> light; ///< of its last picture
        bool punctual = true, small = false; ///< small: of a picture of light that is smaller than the view;
                                             ///< punctual: the light of punctual lights is in its L1
        gi::CameraRays rays{}, earlier{};    ///< of this frame and the one before
        std::shared_ptr<gi::Picture const> guides{}; ///< surfaces of the first frame since anything moved
    };
    struct State { ///< of the last frame
        std::vector<Seen> seen;
        int still = 0;               ///< frames since the scene, a setting or the camera last changed
        double still_paths = 0;      ///< paths per pixel of these frames
        gi::FireflyCounts fireflies; ///< of all frames
    };
    struct Next {         ///< view of a frame
        bool same, moved; ///< as in the last frame: what reuse needs; camera or hidden pixels
        gi::CameraRays rays, earlier;
    };
    using Results = std::vector<gi::RenderResult>;
    /// Light that a view has taken from another of the same frame.
    gi::ReusedLight taken(std::size_t view, int partner, Results const& results) const;
    /// Averages a view over frames, if there is temporal reuse. The partner must have been averaged already.
    /// @return surfaces and light of pixels that show mirrors
    gi::MirrorLayers reuse(std::size_t view, Results& results, int partner, gi::SceneChange change,
                           Settings const& settings, gi::SeenSurfaces* seen);
    /// While all stands still, filters follow the same surfaces in each frame: else outlines, of which each frame's points see
    /// one side or the other, would flicker.
    void hold_guides(std::size_t view, gi::Picture& picture);
    /// The views of this frame are filtered.
    bool is_filtered(gi::RenderResult const& result, Settings const& settings) const;
    /// Clamps the fireflies of all views. Throws Interrupted if `stop`, which may be null, is requested.
    void clamp(Results& results, std::span<ViewCommand const> views, gi::StopRequest const* stop);
    /// Filters a view. The partner must have been filtered already. Throws Interrupted as `clamp` does.
    /// @param unfiltered  shown in part; empty = not
    void filter(std::size_t view, Results& results, int partner, Settings const& settings,
                gi::Picture const& unfiltered, gi::StopRequest const* stop);
    void follow(FrameCommand const& command, std::span<HiddenPixels const> hidden, std::span<Next const> next,
                Settings const& settings);

    gi::Method const& method_;
    std::string choice_;
    gi::Report& report_;
    int threads_;
    gi::dvec3 origin_; ///< of the world
    std::unique_ptr<gi::FrameRenderer> renderer_;
    State state_;
    std::vector<std::vector<gi::SeenImage>> images_; ///< per view
    gi::LightPicture around_;
    bool first_ = true, left_out_punctual_ = false;
    bool ahead_;
};

} // namespace viewer
