#pragma once
// The steps of `study calibrate` that need the window: patches for a photometer, matches by eye, a card.
// Keys: up and down change a value by a step, page up and page down by sixteen, enter takes it, backspace goes
// back, escape ends without a result.

#include "study/display/luminance_fit.h"
#include "viewer/experiment/screens/screen.h"

namespace viewer {

/// Shows each patch; its luminance is typed (a comma is a decimal point) and entered.
/// @param keep  called with all readings after each, so that they outlive what follows
/// @throws gi::InputError the window was closed, or escape was pressed
void measure_patches(Screen& screen, std::vector<study::PatchColour> const& colours,
                     std::vector<double> const& values,
                     std::function<void(std::vector<study::LuminanceReading> const&)> const& keep);

/// Shows lines of which `share` are bright beside an area whose value is adjusted until both look alike (from far
/// enough that lines are not seen). Lines are horizontal, because few displays are too slow for those.
std::vector<study::GammaMatch> match_patterns(Screen& screen, std::vector<study::PatchColour> const& colours,
                                              std::vector<double> const& shares);

/// A rectangle is adjusted until a bank card (ISO/IEC 7810 ID-1: 85.60 x 53.98 mm) held on the screen covers it.
/// @return pixels per centimetre
double match_card(Screen& screen);
inline constexpr double kCardWidth_cm = 8.56, kCardHeight_cm = 5.398;

} // namespace viewer
