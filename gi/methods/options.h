#pragma once
// All options of renders, for command line, viewers, studies, AR sessions and Python.

#include "gi/render/render_option.h"

namespace gi {

/// The options of all methods, common ones first.
RenderOptionTable const& render_options();
/// nullptr if none has this name, key or former key.
RenderOption const* find_render_option(std::string_view name);
/// The option of this name, which must be in the table.
RenderOption const& render_option(std::string_view name);

/// A method that will render.
struct ChosenMethod {
    std::string name;
    Schedule schedule = Schedule::automatic;
    std::string as_given; ///< how the user chose the schedule: "--schedule stored"
};

/// Throws InputError if none of the methods (at least one) reads one of the options, or if they contradict.
/// @param given  names of the options that the user set  @param settings  their values
void check_options(std::vector<std::string> const& given, RenderSettings const& settings,
                   std::vector<ChosenMethod> const& methods);

} // namespace gi
