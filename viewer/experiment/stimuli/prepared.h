#pragma once
// Stimuli rendered ahead: one folder of pictures per stimulus, named by a hash of everything that determines them,
// so that existing folders are valid and are not rendered again.

#include "viewer/experiment/stimuli/stimulus_source.h"

namespace viewer {

/// A stimulus to render ahead.
struct PreparedStimulus {
    StimulusSettings stimulus;
    StimulusView view;
    std::string where{}; ///< position in the script, for messages
};

/// Hash that names a stimulus's folder of pictures for one place on the screen. @param version  of the program
std::string prepared_key(PreparedStimulus const& wanted, std::string const& version);

/// Renders all pictures of a stimulus (one, if nothing in it moves) into FOLDER/KEY, which appears whole. Does
/// nothing if the folder exists and is complete (prepared_files.h).
/// @return true if it was rendered. Throws InputError.
bool prepare_stimulus(PreparedStimulus const& wanted, std::filesystem::path const& folder, std::string const& key,
                      SceneAccess const& scenes, int threads, gi::StopRequest const& stop, gi::Report& report);

/// Shows prepared stimuli.
class PreparedSource : public StimulusSource {
public:
    PreparedSource(std::filesystem::path folder, std::string version)
        : folder_(std::move(folder)), version_(std::move(version))
    {
    }
    /// Throws InputError if the stimulus was not prepared for a place of this size.
    void prepare(StimulusSettings const& stimulus, StimulusView const& view) override;
    bool is_ready() override { return !frames_.empty(); }
    void at(double seconds) override;
    void change(StimulusSettings const& stimulus) override;
    void walk(NavigationInput const& input, double seconds) override;
    void rest() override {}
    bool moves() const override { return false; } // at(0) restarts it
    std::shared_ptr<LiveFrame const> newest() override;

private:
    std::filesystem::path folder_;
    std::string version_;
    std::vector<std::shared_ptr<LiveFrame const>> frames_;
    double duration_s_ = 1, at_s_ = 0;
};

} // namespace viewer
