#pragma once
// The render session: a dynamic scene, its settings, and the state kept from frame to frame. It has no access to
// windows, clocks or devices: the same sequence of changes and frame commands gives bit-identical pixels on any
// number of threads. The live viewer, the ranks of a cluster and the replay of a recording all drive it.

#include "gi/surfaces/antialiasing.h"
#include "gi/surfaces/light_cells.h"
#include "gi/surfaces/planar_mirrors.h"
#include "viewer/engine/headlight.h"
#include "viewer/engine/hidden_views.h"
#include "viewer/engine/method_runner.h"
#include "viewer/engine/scene_edits.h"
#include "viewer/engine/scene_start.h"
#include "viewer/engine/settings.h"

#include <functional>

namespace viewer {

/// Loads the scene of this name, and adds lights if it has none.
using LoadScene = std::function<std::shared_ptr<gi::Scene const>(std::string const& name, gi::Report&)>;
/// Moves bodies in the scene to their tracked poses.
using DriveBodies = std::function<void(gi::Scene const&, FrameCommand const&, gi::Pose&)>;

/// A scene made ready beside the session: read, its world built at scene time 0, and its method started.
struct PreparedScene {
    SceneChange change; ///< what a recording says of it
    std::shared_ptr<gi::Scene const> scene;
    std::unique_ptr<gi::MovingWorld> world;
    Settings settings; ///< that the method was started with
    /// Refers to the world; null: it did not start, or `change` has no start.
    std::unique_ptr<MethodRunner> method;
};
/// Chooses what a scene starts with, once its world is known.
using ChooseStart = std::function<SceneStart(gi::World const&)>;

struct ViewPicture {
    gi::Picture picture;
    std::optional<gi::Picture> compared; ///< of the second method, if any
    HiddenPixels hidden{};               ///< pixels that were not rendered
    glm::ivec2 margin_px{0}; ///< of the pictures: on each side beyond the view, see viewer/engine/picture_margin.h
    /// For those who draw surfaces; null: nobody does.
    std::shared_ptr<gi::LightPicture const> light{};
};

struct SessionFrame {
    std::vector<ViewPicture> views;   ///< in the order of the frame command
    std::uint64_t lamps = 0;          ///< LightPicture::lamps
    bool moved = false;               ///< something in the scene moved since the previous frame
    gi::DynamicUpdate dynamic_update; ///< of the main method, not the compared one
    int still_frames = 0;             ///< frames since anything moved or changed, this one included
    int paths = 0;                    ///< per pixel; fewer than requested if rendering was stopped
    double rays = 0;                  ///< exact rays and look-ups
    std::map<std::string, double> stages_s;
    std::string options; ///< options that the method chose
    std::string choice;  ///< of a method that chooses another: which and why, a sentence; else empty
    std::shared_ptr<gi::ShownScene const> scene; ///< null: nobody draws surfaces
    std::vector<PlacedObject> placed;            ///< where they are then
    std::optional<Headlight> headlight;          ///< if it is on: the last of the scene's lights
    std::shared_ptr<gi::LightCellTable const>
        cells; ///< light of what no picture shows; null: nobody draws surfaces
};

/// Stage of SessionFrame::stages_s in which surfaces of another size than light are drawn.
inline constexpr char const* kSurfacesStage = "first surfaces";
/// The view with width and height multiplied by `scale`, at least 1 pixel.
ViewCommand scaled(ViewCommand view, double scale);
/// False if a view is orthographic or has a lens: then light has the size of the views.
bool has_own_surfaces(FrameCommand const& command);

class RenderSession {
public:
    /// @param report  receives losses and counts; must outlive the session  @param threads  0 = all
    RenderSession(LoadScene load, int threads, gi::Report& report);

    /// Valid keys are those of Settings, scene_edits.h and hidden_mask.h, and "scene". Throws InputError and
    /// changes nothing if the value is invalid.
    void apply(Change const& change);
    /// Makes a scene ready; may run on any thread while the session is in use. The steps (gi/core/step.h) are
    /// those of reading, "world", "start" and of the method. Throws InputError if there is no such scene.
    PreparedScene prepare(std::string const& name, Settings const& settings, ChooseStart const& choose) const;
    /// Makes it the current scene, as apply(prepared.change) does.
    void adopt(PreparedScene prepared);
    /// Renders a frame command, whose changes must have been applied already. Throws InputError without a scene.
    SessionFrame render(FrameCommand const& command, gi::StopRequest const& stop,
                        OnStop on_stop = OnStop::shorten);

    /// Light of another rank's view: what the next frames' cells know besides.
    void learn(gi::LightPicture const& light);

    /// Where the headlight is in the next frame, m, world: of commands whose views are not all views of the frame.
    void headlight_at(gi::dvec3 eye_m) { eye_ = eye_m; }

    /// Sets a callback for every following frame.
    void drive_bodies(DriveBodies drive) { drive_ = std::move(drive); }

    /// Draws surfaces of all following frames, also of commands that leave it to others.
    void draw_all_surfaces() { draws_all_ = true; }

    Settings const& settings() const { return settings_; }
    std::string const& scene_name() const { return shown_.name; }
    SceneChange const& shown_scene() const { return shown_; } ///< as it was prepared
    bool has_scene() const { return world_ != nullptr; }
    bool has_headlight() const { return headlight_.has_value(); } ///< the last of world()'s lights
    gi::World const& world() const { return world_->world(); }
    /// Current position of an object, m, world. Throws InputError if no object has this name.
    gi::dvec3 position_of(std::string const& object) const;
    bool moves() const; ///< true if something in the scene can move by itself
    /// True if light of these views is only for poses near theirs: with bodies, a headlight, or mirrors and panes that nobody else draws.
    bool depends_on_poses(std::vector<ViewCommand> const& views) const;

private:
    void start_method(PreparedScene& scene) const;
    void rebuild(std::shared_ptr<gi::Scene const> scene);
    void place_object(Change const& change);
    void edit_scene(Change const& change);
    void note_headlight(); ///< of a new world
    void restart();
    gi::Changes move_to(FrameCommand const& command);
    void forget_smoothed();
    void forget_cells();
    void learn_light(FrameCommand const& light, SessionFrame& frame);
    void take_light(FrameCommand const& command, SessionFrame& frame) const;
    SessionFrame render_whole(FrameCommand const& command, gi::StopRequest const& stop, OnStop on_stop);
    void draw_surfaces(FrameCommand const& command, SessionFrame& frame);
    void draw_mirrors(FrameCommand const& command, SessionFrame& frame);

    LoadScene load_;
    int threads_;
    gi::Report& report_;
    gi::ReportReader added_{report_};
    Settings settings_;
    SceneChange shown_;
    std::shared_ptr<gi::Scene const> scene_;
    std::shared_ptr<gi::MovingWorld> world_; ///< shared with those who draw its surfaces
    std::vector<PlacedObject> placed_;
    std::vector<Change> edits_; ///< of lights, materials, environment: one per key, reapplied to a new world
    HiddenViews hidden_, hidden_surfaces_,
        hidden_light_;                       ///< of views, and of their pictures of surfaces and light
    std::unique_ptr<gi::SeenSurfaces> seen_; ///< of the world, once needed
    /// A view whose pictures are antialiased.
    struct SmoothedView {
        std::string name;
        gi::CameraRays rays; ///< of its last picture of surfaces
        int width = 0, height = 0;
        gi::Antialiasing antialiasing;
    };
    std::vector<SmoothedView> smoothed_, smoothed_compared_; ///< since surfaces are drawn and light is the same
    std::shared_ptr<gi::ShownScene const> shown_world_;      ///< of the last frame
    gi::PlanarMirrors flat_mirrors_;                         ///< of the same
    std::shared_ptr<gi::LightCellTable const> known_;        ///< to cells_, in the last frame
    std::optional<gi::LightCells> cells_;                    ///< of the world, if surfaces are drawn by others
    DriveBodies drive_;
    std::optional<Headlight> headlight_; ///< if it is on
    std::optional<gi::dvec3> eye_;       ///< for the next frame
    gi::Changes pending_; ///< edits since the last frame
    double time_s_ = 0;   ///< of the last frame
    bool draws_all_ = false;
    std::uint64_t lamps_ = 0; ///< changes of light so far
    std::unique_ptr<MethodRunner> main_, compared_;
};

} // namespace viewer
