#pragma once
// The sounds of a script as samples.

#include "study/script/mistakes.h"
#include "study/script/script.h"
#include "viewer/experiment/sound/sound_samples.h"

#include <filesystem>
#include <memory>

namespace viewer {

/// A sine with ramps of half a period of a cosine.
SoundSamples make_tone(study::Sound const& tone, int rate_hz);
/// Reads what libsndfile reads (WAV, FLAC, AIFF, Ogg, ...), of one or two channels and at most ten minutes.
/// @throws gi::InputError at file_place of the script
SoundSamples read_sound(study::Script const& script, study::Sound const& sound,
                        std::filesystem::path const& folder);

/// All sounds of the script with one rate: that of its files, 48 kHz if it has only tones.
/// @throws gi::InputError as read_sound; files of several rates
std::vector<std::shared_ptr<SoundSamples const>> load_sounds(study::Script const& script,
                                                             std::filesystem::path const& folder);
/// Adds what load_sounds() would throw, of every file.
void find_wrong_sounds(study::Script const& script, std::filesystem::path const& folder, study::Mistakes& m);

} // namespace viewer
