#include "viewer/app/controls.h"
#include "viewer/experiment/trial_presenter.h"

namespace viewer {

study::StepDone TrialPresenter::walk(study::TrialRequest const& where, std::string const& prompt, double length_s)
{
    study::StepDone done{where.step_index, now(), 0, ""};
    experimenter_.status.doing = "free walk";
    if (!prompt.empty()) instruct(prompt, where.step_index);
    study::Block const block = where.block != nullptr ? *where.block : plain_block(*where.script);
    StimulusSettings const s = stimulus_settings(*where.script, block, where.stimuli.front());
    see_in(s.view.value_or(options_.view));
    StimulusSource& from = source(0, study::Stimuli::live, s);
    StereoMode const stereo = *stereo_mode(s.settings.stereo);
    from.prepare(s, {screen_->size_px(), stereo, length_s, 0, on_walls()});
    while (!from.is_ready() && !should_end()) {
        present({});
        for (InputEvent const& e : screen_->take_input()) heed_window(e);
    }
    DisplayLight const light =
        table_light_ ? display_light(*model()->luminance, table_light_, {}) : DisplayLight{};
    auto const pane = [&] {
        ScreenPane p{{0, 0}, screen_->size_px(), from.newest(), stereo, light};
        if (p.frame) p.moment = from.moment(*p.frame);
        return p;
    };
    if (ScreenPane const p = pane(); p.moment) screen_->make_ready(p);
    Controls controls;
    double last_s = now();
    double const end_s = last_s + length_s;
    while (now() < end_s && !should_end()) {
        for (InputEvent const& e : screen_->take_input())
            if (!heed_window(e)) controls.take(e, screen_->size_px().y);
        double const t = now();
        from.walk(controls.motion(t - last_s), t - last_s);
        last_s = t;
        ScreenContent c;
        c.panes = {pane()};
        ScreenSwap const swap = present(c);
        from.drawn_at(swap.drawn_scale);
        if (c.panes[0].frame) keep_pose(seconds(swap.time), views_of(c.panes[0]));
    }
    from.rest();
    done.end_s = now();
    if (done.end_s < end_s) {
        end_early();
        done.reason = "skipped";
    }
    return done;
}

} // namespace viewer
