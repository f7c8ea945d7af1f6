#pragma once
// What `bench pictures` does, checked before it is begun.

#include "viewer/bench/pictures.h"
#include "viewer/bench/pictures_list.h"
#include "viewer/bench/sweep_plan.h"

namespace viewer {

struct PictureBudget {
    std::string name;
    double seconds = 0;      ///< 0 = none
    std::uint32_t paths = 0; ///< 0 = as many as the time allows
};
/// "1path", "16paths", or a time. Throws InputError.
PictureBudget parse_picture_budget(std::string const& text);

struct PictureFilter {
    std::string name; ///< as --denoise has it
    gi::DenoiseSettings settings;
};

struct Skipped {
    std::string what, why; ///< "scene sponza", "there is no file '...'"
};
/// Says on stderr that something is left out, and notes it in the table.
void skip(Skipped const& skipped, BenchTable& table);

struct PicturesPlan {
    gi::RenderSettings settings; ///< the same for all, but for budget, paths and seed
    std::vector<PictureBudget> budgets;
    std::vector<PictureFilter> filters;
    std::vector<SweepMethod> methods;
    std::vector<ListedScene> scenes; ///< or sequences, where `interactive` is asked for
    std::vector<Skipped> skipped;
};

/// Made where it is not there.
std::filesystem::path reference_folder(PicturesOptions const& options);
/// Rows, or pictures of frames: everything that they have in common. Tables that differ in it are not continued.
std::vector<std::pair<std::string, std::string>> common_facts(PicturesOptions const& options,
                                                              PicturesPlan const& plan);

/// Loads no scene. Throws InputError on all that is wrong with the call.
PicturesPlan plan_pictures(PicturesOptions const& options);

} // namespace viewer
