#include "bench/cli/cli.h"

int main(int argc, char** argv) { return groundloop::bench::run_cli(argc, argv); }
