// Table 2: the order parameter, averaged over the second revolution, of runs with different starts (couette_run).

#include "couette.hpp"

int main(int argc, char** argv) {
  using namespace stokes;
  return run_experiment(
      {"table2_order_parameter", {}, {}, [](const Results& results) { collect_table(results, "order_parameter", false); }},
      argc, argv);
}
