// Table 3: the effective viscosity, averaged over the second revolution, of runs with different starts (couette_run).

#include "couette.hpp"

int main(int argc, char** argv) {
  using namespace stokes;
  return run_experiment({"table3_effective_viscosity",
                         {},
                         {},
                         [](const Results& results) { collect_table(results, "effective_viscosity", true); }},
                        argc, argv);
}
