#include <iostream>

#include "sim/scenario/schema.h"

/// Regenerates the schema: scenario_schema > scenarios/schema.json
int main() { std::cout << groundloop::sim::scenario_schema(); }
