#pragma once
// Plays the cues of a trial and says when their sounds began.

#include "study/journal/entries.h"
#include "study/script/script.h"
#include "viewer/experiment/sound/sound_mixer.h"

#include <string>
#include <vector>

namespace viewer {

using SoundBank = std::vector<std::shared_ptr<SoundSamples const>>; ///< by number of the script's sound

class CuePlayer {
public:
    /// @param output  null: without sound   All arguments must outlive it.
    CuePlayer(study::Script const& script, study::Block const& block, SoundMixer* output,
              SoundBank const& sounds);

    /// True if the moment has cues that can be heard.
    bool plays_at(study::CueMoment moment, bool is_first = false) const;
    /// How long before that moment start() must be called, s; 0 without cues.
    double lead_s(study::CueMoment moment, bool is_first = false) const;
    /// Starts the cues of a moment that will come at planned_s. @param at  what it is, for the records
    /// @param is_first  of the stimuli
    void start(study::CueMoment moment, bool is_first, std::string const& at, double planned_s);
    /// The last moment came then.
    void came(double onset_s);
    /// Returns the sounds played, at the end of the trial. Sounds that play continue; later ones are not played.
    std::vector<study::SoundPlayed> take(double now_s);

private:
    struct Started {
        study::SoundPlayed played;
        std::optional<SoundTicket> ticket;
        double planned_s;
    };
    std::vector<study::Cue const*> cues_at(study::CueMoment moment, bool is_first) const;

    study::Script const& script_;
    study::Block const& block_;
    SoundMixer* output_;
    SoundBank const& sounds_;
    std::vector<Started> started_;
    std::size_t first_of_moment_ = 0;
};

} // namespace viewer
