#include "viewer/program.h"

int main(int argc, char** argv) { return viewer::run_program(argc, argv); }
