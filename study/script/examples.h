#pragma once
// The experiments of data/study, embedded in the program: CMake fills in examples.cpp.in.

#include <span>
#include <string_view>

namespace study {

struct StudyExample {
    std::string_view name; ///< "visibility2026"
    std::string_view text;
};
std::span<StudyExample const> study_examples();

} // namespace study
