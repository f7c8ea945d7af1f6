#pragma once
// What the parts of the main loop share: settings as shown, the scene's facts, what is selected, and the way to
// change things.

#include "viewer/app/live_error.h"
#include "viewer/app/scene_facts.h"
#include "viewer/engine/live/navigation.h"
#include "viewer/engine/picking.h"

#include <memory>
#include <mutex>

namespace viewer {

struct Selection {
    Picked picked;
    std::string object, material; ///< names; the node's number where it has none
};

/// Answers that come from the rendering thread, to be read by the main loop.
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
    Settings settings;
    SceneFacts facts;
    gi::Camera first_camera, camera; ///< the second: its lens; where it is, navigation says
    Navigation navigation{gi::dmat4(1), 1, {}};
    std::optional<Selection> selection;
    std::shared_ptr<LiveFrame const> frame; ///< that is shown
    bool drawing = false;                   ///< it is not in the windows yet
    std::optional<LiveError> live_error;
    double screen_distance_m = 2; ///< where both eyes' pictures coincide
    bool ends = false;
    std::string message; ///< the last that went wrong, for the panel
    Inbox inbox;
    LiveRenderer* renderer = nullptr;
    bool is_one_of_ranks = false;                          ///< others render the same orders
    bool has_two_windows = false;                          ///< for StereoMode::two_windows
    std::function<void()> loaded;                          ///< called after another scene was loaded
    bool wants_screenshot = false, own_screenshot = false; ///< the second: by key

    /// Settings take effect on what is shown at once, and in the picture with the next frame. Throws InputError
    /// where a setting cannot be so; what is wrong with an edit of the scene goes to `done`, later, by the inbox.
    void change(Change const& change, std::function<void(std::string const&)> done = {});
    /// By so much, m, in the world.
    void move_selection(gi::dvec3 by);
    /// Reads the facts anew, soon; the ground too, where it is walked on.
    void refresh_facts();
    /// Looks soon whether the ground is still what stays in the scene. Nothing where nobody walks.
    void refresh_ground();
    /// The camera as it is now.
    gi::Camera now() const;
    /// @param at  in [0, 1]^2 of one eye's picture   @param aspect  of the view, where its camera does not say it
    void pick(glm::dvec2 at, double aspect, std::function<void(std::optional<Selection> const&)> done);

private:
    std::weak_ptr<gi::Scene const> ground_of_; ///< whose ground the navigation has
};

} // namespace viewer
