// analysis.py and analysis.R, as `study export` writes them: do they find the truth of simulated observers?
// Skipped visibly where statsmodels (scripts/setup --tests) or R with lme4 are missing.

#include "study/observers/observer.h"
#include "study/power/simulated_record.h"
#include "study/script/script_file.h"
#include "study/tables/export.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace study::test {
namespace {

namespace fs = std::filesystem;

/// Groups of participants by light; ratings, pairs and correct answers at five levels.
Script mixed_script()
{
    return parse_script(R"(schema: study/1
id: mixed
seed: 3
participants: {count: 40}
factors:
  light: {day: {exposure: 0}, dusk: {exposure: -2}}
  scene: [hall, yard]
  method: [exact, good, bad]
reference: {method: exact}
defaults: {stimulus_ms: 500}
counterbalance: {light: {method: between}}
sequence: [rated, which, seen]
blocks:
  rated: {task: rating, cross: [scene, method], repeats: 2, scale: {min: 0, max: 100}}
  which: {task: pair, pairs: {factor: method}, cross: [scene], repeats: 3}
  seen:
    task: 2ifc
    only: {method: [exact]}
    cross: [scene]
    compare: {vary: contrast, against: reference, scale: linear, range: [0, 10], harder: down}
    procedure: {method: constant, levels: [1, 3, 4, 5, 6, 8], trials_per_level: 6}
)",
                        "mixed.yaml");
}

/// 1 JOD is 10 points of the rating; dusk costs 0.5 JOD, and 1 JOD more for `bad`;
/// thresholds are 1 higher at dusk.
ObserverModel mixed_observers(Script const& s)
{
    return read_observers(R"(quality: {method: {good: -0.5, bad: -1}, light: {dusk: -0.5}}
interactions: [{levels: {light: dusk, method: bad}, jod: -1}]
between_sd: 0.15
lapse: 0
side_bias: 0
rating: {best: 0.6, span_jod: 10, between_sd: 0.02}
varied: {contrast: {threshold: 4, slope: 2, between_sd: 0.1, shift: {light: {dusk: 1}}}}
bad: {dropped_frames: 0}
)",
                          "observers.yaml", s);
}

fs::path exported(std::string const& name)
{
    Script const s = mixed_script();
    ObserverModel const model = mixed_observers(s);
    std::vector<RecordedSession> sessions;
    for (int p = 1; p <= s.participants.count; ++p)
        sessions.push_back(simulated_record(s, make_plan(s, p), draw_observer(model, 5, p)));
    fs::path const folder = fs::path(testing::TempDir()) / ("lightwell_" + name);
    fs::remove_all(folder);
    for (TextFile const& f : export_files(s, export_tables(s, sessions))) {
        fs::create_directories((folder / f.path).parent_path());
        std::ofstream(folder / f.path) << f.text;
    }
    return folder;
}

nlohmann::json run(fs::path const& folder, std::string const& command)
{
    std::string const all = "cd '" + folder.string() + "' && " + command + " > out.txt 2> err.txt";
    int const status = std::system(all.c_str());
    std::ifstream in(folder / "models.json"), err(folder / "err.txt");
    auto models = nlohmann::json::parse(in, nullptr, false);
    if (status != 0 || models.is_discarded()) {
        std::string const text{std::istreambuf_iterator<char>(err), {}};
        ADD_FAILURE() << command << ": status " << status << "\n" << text;
    }
    return models;
}

/// Coefficients are named as in patsy and R, which differ.
void expect_near(nlohmann::json const& models, std::string const& block, std::vector<std::string> const& names,
                 double truth, double most_error)
{
    ASSERT_TRUE(models.contains(block)) << block;
    for (std::string const& name : names)
        if (models[block].contains(name)) {
            double const value = models[block][name][0], error = models[block][name][1];
            EXPECT_NEAR(value, truth, 3.5 * error) << block << ": " << name;
            EXPECT_LT(error, most_error) << block << ": " << name;
            EXPECT_GT(error, 0) << block << ": " << name;
            return;
        }
    ADD_FAILURE() << block << " has no " << names.front() << ": " << models[block].dump(1);
}

void expect_truth(nlohmann::json const& m)
{
    std::string const dusk = "C(Q('light'))[T.dusk]", method = "C(Q('method'), Treatment('exact'))";
    expect_near(m, "rated", {"lightdusk", dusk}, -5, 4);
    expect_near(m, "rated", {"methodgood", method + "[T.good]"}, -5, 4);
    expect_near(m, "rated", {"lightdusk:methodbad", dusk + ":" + method + "[T.bad]"}, -10, 5);
    double const z = 0.6745; // per JOD
    expect_near(m, "which", {"level_2", "good"}, -0.5 * z, 0.1);
    expect_near(m, "which", {"level_3", "bad"}, -1.5 * z, 0.15); // mean over the groups: -1 and -2
    expect_near(m, "seen", {"x", "Q('x')"}, 0.5, 0.06);
    // Threshold 4 at day, 5 at dusk, slope 2: -(t - 4) / 2.
    expect_near(m, "seen", {"(Intercept)", "Intercept"}, -2, 0.35);
}

TEST(MixedModels, OfPythonFindTheTruthOfSimulatedObservers)
{
    fs::path const python = fs::path(LIGHTWELL_SOURCE_DIR) / "build" / "python" / "bin" / "python";
    if (!fs::exists(python.parent_path().parent_path() / "statistics"))
        GTEST_SKIP() << "SKIPPED: statsmodels is not installed (scripts/setup --tests installs it from PyPI)";
    fs::path const folder = exported("mixed_python");
    std::ofstream(folder / "run.py") << R"(import json, runpy
models = runpy.run_path("analysis.py")["models"]
out = {b: {n: [float(m.params[n]), float(m.bse[n])] for n in m.params.index} for b, m in models.items()}
json.dump(out, open("models.json", "w"))
)";
    expect_truth(run(folder, "'" + python.string() + "' run.py"));
}

TEST(MixedModels, OfRFindTheTruthOfSimulatedObservers)
{
    if (std::system("Rscript -e 'library(lme4)' > /dev/null 2>&1") != 0)
        GTEST_SKIP() << "SKIPPED: R with lme4 is not installed";
    fs::path const folder = exported("mixed_r");
    std::ofstream(folder / "run.R") << R"(source("analysis.R")
block <- function(m) paste0("{", paste(sprintf("\"%s\": [%.9g, %.9g]", gsub("`", "", rownames(coef(summary(m)))),
  coef(summary(m))[, 1], coef(summary(m))[, 2]), collapse = ", "), "}")
cat("{", paste(sprintf("\"%s\": %s", names(models), sapply(models, block)), collapse = ", "), "}", file = "models.json")
)";
    expect_truth(run(folder, "Rscript run.R"));
}

} // namespace
} // namespace study::test
