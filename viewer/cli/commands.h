#pragma once
// One function per subcommand, which declares its options and the callback that runs it.

namespace CLI {
class App;
}

namespace viewer {

void add_render(CLI::App& app, int& exit_code);
void add_view(CLI::App& app, int& exit_code);
void add_compare(CLI::App& app, int& exit_code);
void add_denoise(CLI::App& app, int& exit_code);
void add_info(CLI::App& app, int& exit_code);
void add_generate(CLI::App& app, int& exit_code);
void add_recording(CLI::App& app, int& exit_code);
void add_remote(CLI::App& app, int& exit_code);
void add_track(CLI::App& app, int& exit_code);
void add_display(CLI::App& app, int& exit_code);
void add_avatar(CLI::App& app, int& exit_code);
void add_xr(CLI::App& app, int& exit_code);
void add_study(CLI::App& app, int& exit_code);
void add_ar(CLI::App& app, int& exit_code);
void add_bench(CLI::App& app, int& exit_code);
void add_batch(CLI::App& app, int& exit_code);
// Within study
void add_study_check(CLI::App& study, int& exit_code);
void add_study_run(CLI::App& study, int& exit_code);
void add_study_control(CLI::App& study, int& exit_code);
void add_study_prepare(CLI::App& study, int& exit_code);
void add_study_calibrate(CLI::App& study, int& exit_code);
void add_study_photodiode(CLI::App& study, int& exit_code);
void add_study_simulate(CLI::App& study, int& exit_code);
void add_study_power(CLI::App& study, int& exit_code);
void add_study_tables(CLI::App& study, int& exit_code);  ///< rebuild, export
void add_study_analyze(CLI::App& study, int& exit_code); ///< analyze, report
// Within ar
void add_ar_synthesize(CLI::App& ar, int& exit_code);
void add_ar_run(CLI::App& ar, int& exit_code);
void add_ar_track(CLI::App& ar, int& exit_code);
void add_ar_bench(CLI::App& ar, int& exit_code);
void add_ar_cameras(CLI::App& ar, int& exit_code);
void add_ar_record(CLI::App& ar, int& exit_code);
void add_ar_replay(CLI::App& ar, int& exit_code);
void add_ar_board(CLI::App& ar, int& exit_code);
void add_ar_map(CLI::App& ar, int& exit_code);
void add_ar_albedo(CLI::App& ar, int& exit_code);
void add_ar_light(CLI::App& ar, int& exit_code);
void add_ar_calibrate(CLI::App& ar, int& exit_code);
void add_ar_response(CLI::App& ar, int& exit_code);
void add_ar_vignetting(CLI::App& ar, int& exit_code);
void add_ar_noise(CLI::App& ar, int& exit_code);
void add_ar_colour(CLI::App& ar, int& exit_code);
void add_ar_probe(CLI::App& ar, int& exit_code);
void add_ar_lens(CLI::App& ar, int& exit_code);
// Within bench
void add_bench_dynamic(CLI::App& bench, int& exit_code);
void add_bench_sweep(CLI::App& bench, int& exit_code);
void add_bench_pictures(CLI::App& bench, int& exit_code);
void add_bench_shown(CLI::App& bench, int& exit_code);
void add_bench_views(CLI::App& bench, int& exit_code);
void add_bench_schedules(CLI::App& bench, int& exit_code);
void add_bench_report(CLI::App& bench, int& exit_code);
void add_bench_rays(CLI::App& bench, int& exit_code);
void add_bench_raster(CLI::App& bench, int& exit_code);
void add_bench_accuracy(CLI::App& bench, int& exit_code);
void add_bench_thesis(CLI::App& bench, int& exit_code);

} // namespace viewer
