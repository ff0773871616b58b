// Section 4.3: fluid is injected through both walls of an annulus until t = 4 and drawn back until t = 8, past 50 free
// discs and a ring of 41 fixed ones (Figures 5 and 6). One case for each seed of the random places; _stiv: interference
// volumes; _plain: 32 nodes at equal steps, without clusters near contacts.

#include "experiment.hpp"
#include "neighbours.hpp"
#include "packing.hpp"
#include "simulation.hpp"

namespace {

using namespace stokes;

constexpr double radius = 0.25, reverse_at = 4.0, end_time = 8.0;
constexpr int free_count = 50, fixed_count = 41, body_points = 32;
const std::vector<double> snapshot_times = {0.0, 2.0, 4.0, 6.0, 8.0};

Suspension start(std::uint64_t seed, double separation) {
  const Body fixed{{radius, radius}, {}, 0.0, 0.0, true};
  Suspension ring_alone;
  for (const Body& body : ring(fixed, fixed_count, 5.0)) ring_alone.push_back(body);
  RandomPlacement placement{.shape = {radius, radius}, .count = free_count};
  placement.inner_radius = 1.0 + radius, placement.outer_radius = 4.5 - radius;
  placement.density = RadialDensity::uniform_area;
  placement.min_distance = separation;
  placement.seed = seed;
  Suspension bodies;
  for (const Body& body : random_bodies(placement, ring_alone)) bodies.push_back(body);
  bodies.insert(bodies.end(), ring_alone.begin(), ring_alone.end());
  Annulus annulus{0.5, 10.0, 128};
  annulus.inner_surface.source = annulus.outer_surface.source = pi;
  return between_walls(std::move(bodies), annulus);
}

SimulationOptions options_of(ContactModel contact, Refine refine, double time_step, double separation) {
  SimulationOptions options;
  options.stepper.flow.kind = FlowKind::none;
  options.stepper.points_per_body = body_points;
  options.stepper.refine = refine;
  options.stepper.stokes.gmres_tolerance = 1e-6;
  options.stepper.contact = contact;
  options.stepper.separation = separation;
  options.time_step = time_step;
  options.end_time = end_time;
  options.reverse_at = reverse_at;
  return options;
}

void run_case(const std::string& name, const Results& results) {
  const auto seed = static_cast<std::uint64_t>(name[4] - '0');
  const ContactModel contact = name.ends_with("_stiv") ? ContactModel::stiv : ContactModel::gap;
  const Refine refine = name.ends_with("_plain") ? Refine::none : Refine::near;
  const double separation = 0.2 * 2.0 * pi * radius / body_points, time_step = 0.02;
  const Suspension bodies = start(seed, separation);
  std::vector<std::vector<double>> snapshots, steps;
  std::vector<bool> in_contact(bodies.size());
  Suspension last;
  std::size_t next = 0;
  double gap = smallest_gap(bodies).gap, largest_ncp = 0.0, first_contact = std::nan(""), last_contact = 0.0;
  simulate(bodies, options_of(contact, refine, time_step, separation), [&](const StepRecord& record) {
    gap = std::min(gap, record.min_gap);
    if (next < snapshot_times.size() && record.time > snapshot_times[next] - 1e-9) {
      for (std::size_t i = 0; i < record.bodies.size(); ++i) {
        const Pose& pose = record.bodies[i].pose;
        snapshots.push_back({record.time, static_cast<double>(i), pose.centre.real(), pose.centre.imag(), pose.angle,
                             record.bodies[i].shape.a, record.bodies[i].fixed ? 1.0 : 0.0, in_contact[i] ? 1.0 : 0.0});
      }
      ++next;
    }
    last = record.bodies;
    std::fill(in_contact.begin(), in_contact.end(), false);
    if (!record.outcome) return;
    const StepOutcome& outcome = *record.outcome;
    for (const ActiveContact& c : outcome.contacts) {
      in_contact[c.constraint.a] = true;
      if (c.constraint.b != container_index) in_contact[c.constraint.b] = true;
    }
    largest_ncp = std::max<double>(largest_ncp, outcome.ncp_iterations);
    if (!outcome.contacts.empty()) {
      if (std::isnan(first_contact)) first_contact = record.time;
      last_contact = record.time + outcome.dt;
    }
    steps.push_back({record.time, static_cast<double>(outcome.contacts.size()), record.min_gap,
                     static_cast<double>(outcome.gmres_iterations), static_cast<double>(outcome.ncp_iterations)});
  });
  double sum = 0.0, largest = 0.0;
  for (int i = 0; i < free_count; ++i) {
    const double moved = std::abs(last[i].pose.centre - bodies[i].pose.centre);
    sum += moved;
    largest = std::max(largest, moved);
  }
  results.write(name + "_snapshots", {"time", "body", "x", "y", "theta", "radius", "fixed", "in_contact"}, snapshots);
  results.write(name + "_steps", {"time", "contacts", "min_gap", "gmres_iterations", "ncp_iterations"}, steps);
  results.write(name, {{"mean_displacement", sum / free_count},
                       {"largest_displacement", largest},
                       {"smallest_gap_over_separation", gap / separation},
                       {"largest_ncp_iterations", largest_ncp},
                       {"first_contact", first_contact},
                       {"last_contact", last_contact}},
                {{"seed", format_number(static_cast<double>(seed))}, {"time_step", format_number(time_step)}});
}

}  // namespace

int main(int argc, char** argv) {
  return run_experiment({"fig6_injection", {"seed1", "seed2", "seed3", "seed1_plain", "seed1_stiv"}, run_case, [](const Results&) {}},
                        argc, argv);
}
