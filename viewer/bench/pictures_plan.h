#pragma once
// Plan of `bench pictures`, checked before rendering.

#include "viewer/bench/pictures.h"
#include "viewer/bench/pictures_list.h"
#include "viewer/bench/sweep_plan.h"

namespace viewer {

struct PictureBudget {
    std::string name;
    double seconds = 0;      ///< 0 = none
    std::uint32_t paths = 0; ///< 0 = as many as the time allows
};
/// Parses "1path", "16paths" or a time. Throws InputError.
PictureBudget parse_picture_budget(std::string const& text);

struct PictureFilter {
    std::string name; ///< as in --denoise
    gi::DenoiseSettings settings;
};

struct Skipped {
    std::string what, why; ///< "scene sponza", "there is no file '...'"
};
/// Reports on stderr and in the table that something is skipped.
void skip(Skipped const& skipped, BenchTable& table);

struct PicturesPlan {
    gi::RenderSettings settings; ///< common to all renders, except budget, paths and seed
    std::vector<PictureBudget> budgets;
    std::vector<PictureFilter> filters;
    std::vector<SweepMethod> methods;
    std::vector<ListedScene> scenes; ///< sequences with `interactive`
    std::vector<Skipped> skipped;
};

/// Folder of the reference pictures; created if missing.
std::filesystem::path reference_folder(PicturesOptions const& options);
/// Facts that all rows, or all frames, have in common. Tables with other facts are not continued.
std::vector<std::pair<std::string, std::string>> common_facts(PicturesOptions const& options,
                                                              PicturesPlan const& plan);

/// Makes the plan without loading scenes. Throws InputError if the call is invalid.
PicturesPlan plan_pictures(PicturesOptions const& options);

} // namespace viewer
