#pragma once
// Sessions of small pictures that are soon ready, answered by keys.

#include "tests/viewer_trials/running_session.h"

namespace viewer::test {

inline double steady_s()
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// @param hz  at which pictures are shown; the test of the display takes 50
inline std::string tiny_script(std::string const& timing, std::string const& sequence, std::string const& blocks,
                          int hz = 100)
{
    return fmt::format(R"(schema: study/1
id: tiny
seed: 4
participants: {{count: 2}}
timing: {{expected_hz: {}, calibrate: {{frames: 50}}, {}}}
factors: {{bounces: [0, 2]}}
defaults: {{settings: {{method: slhb, scene: cornell, paths: 1, scale: 1}}, iti_ms: 100, isi_ms: 200, warmup_frames: 2}}
sequence: {}
record: {{markers: [udp]}}
blocks:
{})",
                       hz, timing, sequence, blocks);
}

inline std::string const kPair = "  better: {task: pair, prompt: better, pairs: {factor: bounces}, repeats: 10}\n";

#define NEED_KEYS(run)                                                                                            \
    if (!(run).window().key_problem().empty()) GTEST_SKIP() << "SKIPPED: " << (run).window().key_problem()

} // namespace viewer::test
