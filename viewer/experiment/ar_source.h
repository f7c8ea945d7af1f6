#pragma once
#include "viewer/experiment/ar_pictures.h"

#include <future>

namespace viewer {

/// Where `prepare_stimulus` puts what it made of an AR session: FOLDER/KEY with 00000.png ... and stimulus.json.
bool prepare_ar_stimulus(StimulusSettings const& stimulus, StimulusView const& view,
                         std::filesystem::path const& folder, std::string const& key, gi::StopRequest const& stop,
                         gi::Report& report);

/// Shows the pictures of stimuli from AR sessions: all are there before the first is seen. Those of a fixed
/// duration play once; where a stimulus stays until the answer, view.duration_s of it come again and again.
class ArSource : public StimulusSource {
public:
    /// @param prepared  folder of `study prepare`; empty: composited in the background   @param report  outlives
    /// it
    ArSource(std::filesystem::path prepared, std::string version, gi::Report& report);
    ~ArSource() override;

    void prepare(StimulusSettings const& stimulus, StimulusView const& view) override;
    bool is_ready() override;
    void at(double seconds) override { at_s_ = std::max(0.0, seconds); }
    /// The old pictures stay until all new ones are there. Throws InputError where they are prepared.
    void change(StimulusSettings const& stimulus) override;
    /// Throws InputError: a camera's frames are seen from where it was.
    void walk(NavigationInput const& input, double seconds) override;
    void rest() override {}
    bool moves() const override { return false; } // it begins anew with at(0)
    std::shared_ptr<LiveFrame const> newest() override;

private:
    void make();
    void stop();
    void take();

    std::filesystem::path prepared_;
    std::string version_;
    gi::Report& report_;
    StimulusSettings stimulus_;
    StimulusView view_;
    std::shared_ptr<gi::StopRequest> stop_; ///< of what is being made
    std::future<std::vector<ArPicture>> making_;
    std::vector<ArPicture> pictures_;
    std::string made_of_; ///< what they are pictures of
    double at_s_ = 0;
    std::shared_ptr<LiveFrame const> frame_;
    std::size_t frame_number_ = 0;
};

} // namespace viewer
