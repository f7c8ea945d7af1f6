#pragma once
// What the viewer draws over its window while it loads: progress, help, messages.

#include "viewer/app/controls.h"
#include "viewer/engine/live/scene_loader.h"

namespace viewer {

/// A loading screen where there is no picture yet; a line over the picture of the previous scene.
enum class LoadingPlace { alone, over_picture };

/// Draws the progress between Panel::begin and finish.
void fill_loading(LoadProgress const& progress, LoadingPlace where);
/// Draws what a frame that takes long is at: the start of a method, usually.
void fill_building(LoadProgress const& progress);
/// Draws the table of keys.
void fill_help(std::span<KeyMeaning const> keys);
/// Draws a message at the upper edge.
void fill_message(std::string const& message);

} // namespace viewer
