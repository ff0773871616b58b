// One sentence about each program of this folder, for its --help.
#pragma once

#include <string_view>
#include <utility>

namespace stokes {

// Empty for a program that is not in the list.
inline std::string_view about(std::string_view program) {
  constexpr std::pair<std::string_view, std::string_view> programs[] = {
      {"adaptive_steps", "Section 3.3: the runs of Table 1 at delta = 3h with fixed and with adaptive steps."},
      {"close_evaluation", "Section 3.1: errors of the near-singular quadrature and of the trapezoid rule beside a circle."},
      {"contact_variants", "Figures 2 and 3 with every variant of the contact algorithm."},
      {"couette_run", "Section 4.4: a suspension between rotating cylinders for two revolutions; the runs behind\n"
                      "Figures 8 to 10 and Tables 2 and 3."},
      {"fig2_shear_separation", "Figure 2: two discs in shear for several minimum separations, and their displacement."},
      {"fig3_pathlines", "Figure 3: pathlines of two discs in shear from three heights."},
      {"fig4_taylor_green", "Figure 4: 48 ellipses in the Taylor-Green flow for three time steps."},
      {"fig6_injection", "Figures 5 and 6: fluid injected past 50 free and 41 fixed discs, and drawn back."},
      {"fig7_shear_stress", "Figure 7: the shear stress at six times of the injection, and what the paper plotted."},
      {"fig8_initial_configurations", "Figure 8: the suspensions between the cylinders at the start."},
      {"fig9_order_parameter", "Figure 9: the order parameter in time, from the runs of couette_run."},
      {"fig10_effective_viscosity", "Figure 10: the effective viscosity in time, from the runs of couette_run."},
      {"local_coupling", "Section 4.1, a claim: locally implicit stepping collides where globally implicit does not."},
      {"ncp_iterations", "Section 3.2: how many linear complementarity problems a contact takes."},
      {"resolved", "Runs of the paper with its 32 nodes a body and with velocities to 1e-6: Table 1, the Taylor-Green flow\n"
                   "to t = 10, the injection, a suspension between cylinders for a quarter of a revolution."},
      {"table1_reversibility", "Table 1: the error of two discs in a shear flow that is reversed."},
      {"table2_order_parameter", "Table 2: the mean order parameter over the second revolution from the paper's\n"
                                 "starts, with its spread over other ones."},
      {"table3_effective_viscosity", "Table 3: the mean effective viscosity over the second revolution from the paper's\n"
                                     "starts, with its spread over other ones."},
      {"taylor_green_claims", "Section 4.2: what the text says of steps, collisions, preconditioning and iterations."},
  };
  for (const auto& [name, text] : programs)
    if (name == program) return text;
  return {};
}

}  // namespace stokes
