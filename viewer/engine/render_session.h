#pragma once
// What the viewer renders with: a scene that moves, settings that change, and what is kept from frame to frame.
// It knows no windows, clocks or devices: the same changes and orders in the same sequence give the same pixels,
// bit for bit, on any number of threads. The live viewer, the ranks of a cluster and the replay of a recording are
// three ways to feed it.

#include "viewer/engine/hidden_views.h"
#include "viewer/engine/method_runner.h"
#include "viewer/engine/scene_edits.h"
#include "viewer/engine/settings.h"

#include <functional>

namespace viewer {

/// Reads what a scene's name says, and lights it where it has no light.
using LoadScene = std::function<std::shared_ptr<gi::Scene const>(std::string const& name, gi::Report&)>;
/// Moves bodies in the scene as trackers say.
using DriveBodies = std::function<void(gi::Scene const&, FrameCommand const&, gi::Pose&)>;

struct ViewPicture {
    gi::Picture picture;
    std::optional<gi::Picture> compared; ///< of the second method, where there is one
    HiddenPixels hidden{};               ///< that were left out
};

struct SessionFrame {
    std::vector<ViewPicture> views;   ///< as ordered
    bool moved = false;               ///< something in the scene has, since the frame before
    gi::DynamicUpdate dynamic_update; ///< of the method, not of the one it is compared with
    int still_frames = 0;             ///< since anything moved or changed, this one counted
    int paths = 0;                    ///< per pixel; fewer than ordered where it was stopped
    double rays = 0;                  ///< and look-ups
    std::map<std::string, double> stages_s;
    std::string options; ///< what the method chose
};

class RenderSession {
public:
    /// @param report  gets losses and counts; outlives the session  @param threads  0 = all
    RenderSession(LoadScene load, int threads, gi::Report& report);

    /// Keys are those of Settings, of scene_edits.h, of hidden_mask.h, and "scene". Throws InputError and changes
    /// nothing where the value cannot be.
    void apply(Change const& change);
    /// Renders an order; its changes have been applied already. Throws InputError without a scene.
    SessionFrame render(FrameCommand const& order, gi::StopRequest const& stop);

    /// Called for every frame from now on.
    void drive_bodies(DriveBodies drive) { drive_ = std::move(drive); }

    Settings const& settings() const { return settings_; }
    std::string const& scene_name() const { return name_; }
    bool has_scene() const { return world_ != nullptr; }
    gi::World const& world() const { return world_->world(); }
    /// Where an object is now, m, world. Throws InputError where there is none of that name.
    gi::dvec3 position_of(std::string const& object) const;
    bool moves() const; ///< something in the scene can move by itself

private:
    void load(Change const& change);
    void rebuild(std::shared_ptr<gi::Scene const> scene);
    void place_object(Change const& change);
    void restart();
    gi::Changes move_to(FrameCommand const& order);

    LoadScene load_;
    int threads_;
    gi::Report& report_;
    gi::ReportReader added_{report_};
    Settings settings_;
    std::string name_;
    std::shared_ptr<gi::Scene const> scene_;
    std::unique_ptr<gi::MovingWorld> world_;
    std::vector<PlacedObject> placed_;
    std::vector<Change> edits_; ///< of lights, materials, environment: one per key, made again in a new world
    HiddenViews hidden_;
    DriveBodies drive_;
    gi::Changes pending_; ///< edits since the last frame
    double time_s_ = 0;   ///< of the last frame
    std::unique_ptr<MethodRunner> main_, compared_;
};

} // namespace viewer
