#pragma once
// State shared by the parts of the main loop: current settings, scene data,
// selection, and functions to change them.

#include "viewer/app/live_error.h"
#include "viewer/app/open_dialog.h"
#include "viewer/engine/live/navigation.h"
#include "viewer/engine/live/scene_loader.h"
#include "viewer/engine/picking.h"

#include <memory>
#include <mutex>

namespace viewer {

/// Copy of the scene's data for the panel and the remote control, because the session
/// belongs to the rendering thread.
struct SceneFacts {
    struct Named {
        std::string name;
        gi::Material material;
    };
    std::string scene;
    std::vector<Named> materials;
    std::vector<gi::Light> lights;
    std::vector<gi::Camera> cameras;
    gi::dvec3 origin{0}, center{0};
    double radius_m = 1;
    std::uint32_t triangles = 0;
    bool moves = false, has_environment = false;
    float environment_rotation_rad = 0, environment_scale = 1;
};
SceneFacts facts_of(RenderSession const& session);

struct Selection {
    Picked picked;
    std::string object, material; ///< names; the node's number if it has none
};

/// Messages from the rendering thread to the main loop.
class Inbox {
public:
    void put(std::function<void()> message)
    {
        std::lock_guard const lock(mutex_);
        messages_.push_back(std::move(message));
    }
    void read()
    {
        std::vector<std::function<void()>> now;
        {
            std::lock_guard const lock(mutex_);
            now.swap(messages_);
        }
        for (auto const& m : now) m();
    }

private:
    std::mutex mutex_;
    std::vector<std::function<void()>> messages_;
};

struct ViewState {
    SessionClock clock;
    SceneFacts facts;
    gi::Camera first_camera, camera; ///< `camera`: only its lens counts; the pose is that of `navigation`
    Navigation navigation{gi::dmat4(1), 1, {}};
    std::optional<Selection> selection;
    std::shared_ptr<LiveFrame const> frame; ///< currently shown
    bool drawing = false;                   ///< `frame` is not in the windows yet
    std::optional<LiveError> live_error;
    double screen_distance_m = 2; ///< distance where both eyes' pictures coincide
    bool ends = false, shows_help = false;
    OpenDialog open_dialog;
    std::string message; ///< last error, for the panel
    Inbox inbox;
    LiveRenderer* renderer = nullptr;
    bool is_one_of_ranks = false; ///< other ranks render the same frame commands
    bool follows = false;         ///< one of them leads
    bool has_two_windows = false; ///< for StereoMode::two_windows
    /// Begins to load a scene; `done` as in change().
    std::function<void(std::string const& name, std::function<void(std::string const&)> done)> load;
    std::optional<LoadProgress> loading;                   ///< of a scene that is not shown yet
    std::optional<LoadProgress> building;                  ///< what a frame that takes long is at
    bool wants_screenshot = false, own_screenshot = false; ///< own_screenshot: requested by key

    /// The settings of the viewer, which only change(), expose() and follow() change. The rendering thread gets every
    /// change in order; a frame says which settings it was rendered with.
    Settings const& settings() const { return settings_; }
    /// Applies a setting, or those of kQuality, to the display at once and to the rendering with the next frame. Throws InputError if a
    /// setting is invalid. Errors in edits of the scene are passed to `done` later, through the inbox.
    void change(Change const& change, std::function<void(std::string const&)> done = {});
    /// Automatic exposure: changes the exposure and goes on.
    void expose(double ev);
    /// The settings before the first frame.
    void begin(Settings const& settings) { settings_ = settings; }
    /// Takes over what the renderer of a frame has set itself; on ranks that follow, all settings, as the leader's.
    void follow(Settings const& of_frame);
    /// Loads a scene that the user chose.
    void open_scene(std::string const& name);
    /// Moves the selected object by an offset, m, in the world.
    void move_selection(gi::dvec3 by);
    /// Requests an update of the facts, and of the ground in walk mode.
    void refresh_facts();
    /// Requests an update of the ground if the scene's static geometry changed. Does nothing outside walk mode.
    void refresh_ground();
    /// The current camera.
    gi::Camera now() const;
    /// @param at  in [0, 1]^2 of one eye's picture   @param aspect  of the view, if its camera does not define it
    void pick(glm::dvec2 at, double aspect, std::function<void(std::optional<Selection> const&)> done);
    /// The same along the -Z axis of a pose, from its origin.
    void pick_along(gi::dmat4 const& world_from_ray, std::function<void(std::optional<Selection> const&)> done);

private:
    void pick_by(gi::Camera const& eye, glm::dvec2 at, double aspect,
                 std::function<void(std::optional<Selection> const&)> done);

    Settings settings_;
    std::weak_ptr<gi::Scene const> ground_of_; ///< scene of the navigation's ground
};

} // namespace viewer
