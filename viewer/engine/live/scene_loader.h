#pragma once
// Makes scenes ready on a thread of its own while the previous one is shown, and says how far it is.

#include "gi/core/progress.h"
#include "gi/core/step.h"

#include <exception>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

namespace viewer {

struct LoadProgress {
    std::string scene;
    gi::Step step; ///< that the work is at
    double elapsed_s = 0;
    /// Estimated share of the work that is done, 0..1: each of reading, textures, world and method has a fixed
    /// share, of which only counted parts (Step::of) are known.
    double fraction = 0;
};

/// The progress as one line: "loading sponza.glb: textures decoded 12 of 24, 3.2 s".
std::string text_of(LoadProgress const& progress);
/// @see LoadProgress::fraction
double fraction_of(gi::Step const& step);

class SceneLoader {
public:
    /// Called on the loading thread once for each load: with null when the work was done, else with why not;
    /// gi::Interrupted if another load replaced it.
    using Done = std::function<void(std::exception_ptr failure)>;

    ~SceneLoader(); ///< stops and waits

    /// Starts the work; a load that still runs is told to stop at its next step, and its result is not used. The
    /// new one begins when that has ended (call progress() now and then), so that memory holds one load at a time.
    void begin(std::string scene, std::function<void()> work, Done done);
    /// Of the newest load, while it runs.
    std::optional<LoadProgress> progress();
    /// Tells all loads to stop at their next step.
    void stop();

private:
    struct Load;
    void collect();
    void drop_next();

    // Used by the thread that begins loads.
    std::shared_ptr<Load> running_, next_; ///< null = none
};

} // namespace viewer
