#pragma once
// Converts a script's procedures to settings of study/adaptive: for sessions that run
// them and analyses that replay them.

#include "study/adaptive/questplus.h"
#include "study/adaptive/staircase.h"
#include "study/script/script.h"

namespace study {

/// Sign that makes lower values harder, as staircases need: the scale of `compare` is multiplied by it; -1 if a
/// higher level is harder.
double harder_sign(Compare const& compare);
StaircaseSettings staircase_settings(Procedure const& procedure, Compare const& compare);
/// Stimuli and thresholds are in levels for the Weibull function, otherwise on the scale.
QuestSettings quest_settings(Procedure const& procedure, Compare const& compare);

/// Of a procedure with further settings or parameters (is_many): x, then further levels; threshold, slope, guess,
/// lapse, then further parameters.
QuestManySettings quest_many_settings(Procedure const& procedure);
/// Levels of further settings as text for journals: "camera.fov=40 light.0.scale=2"; empty = none.
std::string further_text(Compare const& compare, std::vector<double> const& levels);
/// Inverse of further_text; empty if the text is not one of these settings.
std::vector<double> further_of_text(Compare const& compare, std::string const& text);

QuestFunction quest_function(Psychometric function);
/// Shape and axis of a function to fit: harder levels are lower on the axis.
PsychometricShape shape_of(Scale scale, bool harder_up, PsychometricChoice const& function = {});
/// Proportion correct at a level. @param p  threshold as a level, the slope in its function's units
double proportion_correct(PsychometricChoice const& function, Scale scale, bool harder_up, QuestParameters p,
                          double level);
/// Level at which it is `proportion`, within 60 dB of the threshold or 1000 slopes; NaN if there is none.
double level_of_proportion(PsychometricChoice const& function, Scale scale, bool harder_up,
                           QuestParameters const& p, double proportion);

} // namespace study
