#pragma once
// Displays that several tests use.

#include "gi/core/file.h"
#include "viewer/displays/display_file.h"

#include <gtest/gtest.h>
#include <random>

namespace viewer::test {

inline Display shipped(std::string const& name)
{
    gi::Report report;
    Display d = load_display(std::string(LIGHTWELL_SOURCE_DIR "/data/displays/") + name, report);
    for (auto const& [what, loss] : report.losses()) ADD_FAILURE() << name << ": " << what << ": " << loss.first;
    return d;
}

/// Wherever and however turned; edges of 0.1 to 10 m.
inline WallCorners random_wall(std::mt19937& random, double spread_m = 5)
{
    std::uniform_real_distribution<double> place(-spread_m, spread_m), edge(-1, 1);
    std::normal_distribution<double> normal;
    gi::dquat const turn =
        glm::normalize(gi::dquat{normal(random), normal(random), normal(random), normal(random)});
    gi::dvec3 const ll{place(random), place(random), place(random)};
    double const width = std::pow(10, edge(random)), height = std::pow(10, edge(random));
    return {ll, ll + turn * gi::dvec3{width, 0, 0}, ll + turn * gi::dvec3{0, height, 0}};
}

/// The message of the InputError; empty if none was thrown.
template <typename Call>
std::string message_of(Call const& call)
{
    try {
        call();
    } catch (gi::InputError const& e) {
        return e.what();
    }
    return {};
}

} // namespace viewer::test
