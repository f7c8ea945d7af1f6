#include "viewer/experiment/sound/cue_player.h"

#include <algorithm>
#include <chrono>
#include <thread>

namespace viewer {

CuePlayer::CuePlayer(study::Script const& script, study::Block const& block, SoundMixer* output,
                     SoundBank const& sounds)
    : script_(script), block_(block), output_(output), sounds_(sounds)
{
}

std::vector<study::Cue const*> CuePlayer::cues_at(study::CueMoment moment, bool is_first) const
{
    std::vector<study::Cue const*> cues;
    for (study::Cue const& c : block_.cues)
        if (c.at == moment || (is_first && c.at == study::CueMoment::first_stimulus)) cues.push_back(&c);
    return cues;
}

bool CuePlayer::plays_at(study::CueMoment moment, bool is_first) const
{
    return output_ != nullptr && !cues_at(moment, is_first).empty();
}

double CuePlayer::lead_s(study::CueMoment moment, bool is_first) const
{
    if (output_ == nullptr) return 0;
    double lead = 0;
    for (study::Cue const* c : cues_at(moment, is_first))
        lead = std::max(lead, output_->lead_s() - 1e-3 * c->offset_ms);
    return lead;
}

void CuePlayer::start(study::CueMoment moment, bool is_first, std::string const& at, double planned_s)
{
    first_of_moment_ = started_.size();
    for (study::Cue const* c : cues_at(moment, is_first)) {
        auto const& sound = sounds_.at(std::size_t(c->sound));
        Started s;
        s.played.sound = script_.sounds[std::size_t(c->sound)].name;
        s.played.at = at;
        s.played.event_s = planned_s;
        s.played.offset_ms = c->offset_ms;
        s.played.duration_s = sound->duration_s();
        s.planned_s = planned_s + 1e-3 * c->offset_ms;
        if (output_ == nullptr)
            s.played.missing = "without sound";
        else if (s.ticket = output_->start(sound, s.planned_s); !s.ticket)
            s.played.missing = "too many sounds";
        started_.push_back(std::move(s));
    }
}

void CuePlayer::came(double onset_s)
{
    for (std::size_t i = first_of_moment_; i < started_.size(); ++i) started_[i].played.event_s = onset_s;
}

std::vector<study::SoundPlayed> CuePlayer::take(double now_s)
{
    std::vector<study::SoundPlayed> all;
    for (Started& s : started_) {
        if (s.ticket) {
            SoundReport r = output_->report(*s.ticket);
            // Sounds that are due play with the device's next buffers.
            for (int i = 0; i < 100 && !r.onset_s && s.planned_s <= now_s && output_->is_running(); ++i) {
                std::this_thread::sleep_for(std::chrono::milliseconds(5));
                r = output_->report(*s.ticket);
            }
            output_->release(*s.ticket);
            s.played.onset_s = r.onset_s;
            s.played.underruns = r.underruns;
            if (!r.onset_s) s.played.missing = s.planned_s > now_s ? "trial ended" : "device failed";
        }
        all.push_back(s.played);
    }
    started_.clear();
    return all;
}

} // namespace viewer
