#pragma once
// Levels of x86-64 processors (System V ABI): what a program was compiled for, and what runs here.

#include <array>

namespace gi {

/// Best first; packages have programs for each.
inline constexpr std::array<char const*, 3> kProcessorLevels{"x86-64-v4", "x86-64-v3", "x86-64-v2"};

/// The level whose instructions this program was compiled to use, also by -march=native; "x86-64" below the second,
/// "other" for other processors.
extern char const* const kCompiledLevel;

/// True if this machine's processor and system have what the level needs, and for levels that are not in the list.
bool has_level(char const* level);

} // namespace gi
