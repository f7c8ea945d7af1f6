#include "viewer/cli/commands.h"
#include "viewer/cli/program.h"

int main(int argc, char** argv)
{
    static constexpr viewer::AddedCommand kOwn[]{
        {"study check", viewer::add_study_check},         {"study run", viewer::add_study_run},
        {"study control", viewer::add_study_control},     {"study prepare", viewer::add_study_prepare},
        {"study calibrate", viewer::add_study_calibrate},
    };
    return viewer::run_program(argc, argv, kOwn);
}
