#pragma once
// Stimuli rendered ahead: a folder of pictures for each, named by a hash of everything that decides them, so that
// what is there already is right and need not be rendered again.

#include "viewer/experiment/stimulus_source.h"

namespace viewer {

/// What is rendered ahead for one stimulus.
struct PreparedStimulus {
    StimulusSettings stimulus;
    StimulusView view;
    std::string where{}; ///< of the script, for messages
};

/// Pictures of a stimulus, of what is shown of it in one place of the screen. @param version  of the program
std::string prepared_key(PreparedStimulus const& wanted, std::string const& version);

/// Renders all pictures of a stimulus, where nothing in it moves one, into FOLDER/KEY, which appears whole;
/// nothing where it is there and whole (prepared_files.h).
/// @return whether it had to be rendered. Throws InputError.
bool prepare_stimulus(PreparedStimulus const& wanted, std::filesystem::path const& folder, std::string const& key,
                      SceneAccess const& scenes, int threads, gi::StopRequest const& stop, gi::Report& report);

/// Shows them.
class PreparedSource : public StimulusSource {
public:
    PreparedSource(std::filesystem::path folder, std::string version)
        : folder_(std::move(folder)), version_(std::move(version))
    {
    }
    /// Throws InputError where the stimulus was not prepared for a place of this size.
    void prepare(StimulusSettings const& stimulus, StimulusView const& view) override;
    bool is_ready() override { return !frames_.empty(); }
    void at(double seconds) override;
    void change(StimulusSettings const& stimulus) override;
    void walk(NavigationInput const& input, double seconds) override;
    void rest() override {}
    bool moves() const override { return false; } // it begins anew with at(0)
    std::shared_ptr<LiveFrame const> newest() override;

private:
    std::filesystem::path folder_;
    std::string version_;
    std::vector<std::shared_ptr<LiveFrame const>> frames_;
    double duration_s_ = 1, at_s_ = 0;
};

} // namespace viewer
