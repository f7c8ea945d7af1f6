#pragma once
// Stimuli from AR sessions: composites of recorded camera frames.

#include "viewer/experiment/stimuli/ar_pictures.h"

#include <future>

namespace viewer {

/// `prepare_stimulus` for an AR session: writes FOLDER/KEY with 00000.png ... and stimulus.json.
bool prepare_ar_stimulus(StimulusSettings const& stimulus, StimulusView const& view,
                         std::filesystem::path const& folder, std::string const& key, gi::StopRequest const& stop,
                         gi::Report& report);

/// Shows stimuli from AR sessions. All pictures are ready before the first is shown. Stimuli of fixed duration
/// play once; if a stimulus stays until the answer, its first view.duration_s repeat.
class ArSource : public StimulusSource {
public:
    /// @param prepared  folder of `study prepare`; empty = composite in the background
    /// @param report  must outlive this
    ArSource(std::filesystem::path prepared, std::string version, gi::Report& report);
    ~ArSource() override;

    void prepare(StimulusSettings const& stimulus, StimulusView const& view) override;
    bool is_ready() override;
    void at(double seconds) override { at_s_ = std::max(0.0, seconds); }
    /// The old pictures stay until all new ones are ready. Throws InputError for prepared pictures.
    void change(StimulusSettings const& stimulus) override;
    /// Always throws InputError: camera frames have fixed viewpoints.
    void walk(NavigationInput const& input, double seconds) override;
    void rest() override {}
    bool moves() const override { return false; } // at(0) restarts it
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
    std::shared_ptr<gi::StopRequest> stop_; ///< stops the pictures in progress
    std::future<std::vector<ArPicture>> making_;
    std::vector<ArPicture> pictures_;
    std::string made_of_; ///< stimulus that `pictures_` were made of
    double at_s_ = 0;
    std::shared_ptr<LiveFrame const> frame_;
    std::size_t frame_number_ = 0;
};

} // namespace viewer
