#pragma once
#include <string>
#include <vector>

namespace viewer::batch {

/// A command as this version has it, of a manifest for version 0.1: without `schema`, or of schema batch/1. Its method
/// `slhb` has another name now, and `render` and `bench pictures` had other defaults.
std::vector<std::string> current_command(std::vector<std::string> command_of_0_1);

} // namespace viewer::batch
