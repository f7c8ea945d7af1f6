// Prints the plan of a participant as a table: built with every compiler there is, it has to print the same.

#include "study/plan/plan.h"
#include "study/script/script_file.h"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>

int main(int argc, char** argv)
{
    if (argc != 3) return 2;
    std::ifstream in(argv[1], std::ios::binary);
    std::string const text{std::istreambuf_iterator<char>(in), {}};
    try {
        study::Script const script = study::parse_script(text, argv[1]);
        std::string const table = study::plan_table(script, study::make_plan(script, std::atoi(argv[2])));
        return std::fwrite(table.data(), 1, table.size(), stdout) == table.size() ? 0 : 1;
    } catch (gi::InputError const& e) {
        std::fprintf(stderr, "%s\n", e.what());
        return 2;
    }
}
