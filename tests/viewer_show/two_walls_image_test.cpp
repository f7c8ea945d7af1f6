// Surfaces that two walls draw for a moving head have the same light where both show them.

#include "tests/viewer_show/two_walls.h"

#include "tests/viewer_show/live_view.h"

namespace viewer::test {
namespace {

class TwoWalls : public OnScreen {};

TEST_F(TwoWalls, ShowTheSameLight)
{
    TemporaryFolder const folder;
    int const port = free_port();
    write_two_walls(folder / "walls.yaml", port, 1);
    SentHead head(port);
    LiveView view("cornell --display " + (folder / "walls.yaml").string() +
                  " --set refine=false --set play=false");
    view.settle();
    XWindow one("Lightwell: a"), two("Lightwell: b");
    for (double const x : {0.62, 0.6}) { // so that surfaces have been drawn
        head.go_to(x);
        sleep_ms(300);
        view.settle();
    }
    view.set("rate", 0.2); // Hz: the next picture of light waits for 5 s
    view.settle();
    expect_walls_agree(head, one, two);
    view.quit();
}

} // namespace
} // namespace viewer::test
