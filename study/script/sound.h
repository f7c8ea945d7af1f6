#pragma once
// Sounds of a script, and the cues that play them in trials.

#include "study/script/script_error.h"

#include <string>

namespace study {

enum class SoundChannel { both, left, right };

/// A tone, or a file.
struct Sound {
    std::string name;
    std::string file;                          ///< beside the script; empty = a tone
    double tone_hz = 1000;                     ///< of a tone
    double duration_ms = 100;                  ///< of a tone, with its ramps
    double ramp_ms = 5;                        ///< of a tone: rise and fall, half a period of a cosine
    double level_db = -20;                     ///< amplitude of the tone, gain of the file; 0 = full scale
    SoundChannel channel = SoundChannel::both; ///< of a tone
    Place place, file_place;
};

enum class CueMoment {
    fixation,       ///< when the trial begins: the fixation cross appears, where there is one
    first_stimulus, ///< onset of the first stimulus
    each_stimulus,  ///< onset of each stimulus, or of stimuli that are shown together
};

struct Cue {
    int sound = 0; ///< of Script::sounds
    CueMoment at = CueMoment::each_stimulus;
    double offset_ms = 0; ///< from the moment; below 0: before it
};

} // namespace study
