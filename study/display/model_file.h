#pragma once
// The file of a display model (YAML, schema display-model/1; docs/displays.md has its keys).

#include "study/display/display_model.h"

#include <filesystem>

namespace study {

/// @throws gi::InputError with file:line:column
DisplayModel parse_display_model(std::string const& text, std::string const& file);
DisplayModel load_display_model(std::filesystem::path const& file);
/// The text of its file; parsing it gives the same model.
std::string display_model_text(DisplayModel const& model);

/// Lines for people: size, pixels per degree, luminance, gamma with residuals.
std::string display_model_summary(DisplayModel const& model);
/// Facts for the records of a session: display_model (name and date), its hash, pixels per degree, luminances.
std::vector<std::pair<std::string, std::string>> display_model_facts(DisplayModel const& model);

} // namespace study
