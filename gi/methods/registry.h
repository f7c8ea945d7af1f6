#pragma once
// Table of the light-transport methods by name, with their options. One entry makes a method available on the
// command line, in benchmarks, in viewers, in studies, in Python and in --help.

#include "gi/render/method.h"
#include "gi/methods/names.h"

#include <span>
#include <string_view>

namespace gi {

/// All methods; those of earlier versions come last and are not offered.
std::span<Method const> methods();
/// Names of the methods that are offered.
std::vector<std::string> method_names();
/// Throws InputError, listing the known methods.
Method const& find_method(std::string_view name);

/// The options of all methods, common ones first; those of earlier versions have RenderOption::replaced_by.
RenderOptionTable const& render_options();
/// nullptr if none has this name, key or former key.
RenderOption const* find_render_option(std::string_view name);
/// The option of this name, which must be in the table.
RenderOption const& render_option(std::string_view name);
/// All options that a method reads, with their values, as on the command line.
std::string options_of(std::string_view method, RenderSettings const& settings);

/// A method that will render.
struct ChosenMethod {
    std::string name;
    RenderSettings settings;
    std::string as_given = {}; ///< how the user chose it and its settings, if not by options: "--methods slhb:stored"
};

/// Throws InputError if none of the methods (at least one) reads one of the options, or if they contradict.
/// @param given  names of the options that the user set
void check_options(std::vector<std::string> const& given, std::vector<ChosenMethod> const& methods);

} // namespace gi
