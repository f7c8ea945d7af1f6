#pragma once
// Quality in steps from fast to exact. A step is a name for the settings that trade the error of pictures for time, with
// every method: choosing it changes them, and nothing else remembers it.

#include "viewer/engine/settings.h"

#include <optional>

namespace viewer {

/// The key under which people choose a step, as they set a setting: "quality=exact".
constexpr char const* kQuality = "quality";

/// The names of the steps, from fast to exact.
std::span<std::string const> quality_names();
/// What the change of a setting changes: for kQuality the settings of that step, else itself.
/// Throws InputError if there is no such step.
std::vector<Change> changes_of(Change const& change);
/// Index of the step whose settings these are; none if they were set one by one.
std::optional<std::size_t> quality_of(Settings const& settings);
/// Parses "KEY=VALUE" texts to changes of settings, in order. Throws InputError.
std::vector<Change> parse_changes(std::span<std::string const> texts);

} // namespace viewer
