// Limits of the values of a case and of their combinations.
#include <cmath>

#include "case_keys.hpp"
#include "recorder.hpp"
#include "threads.hpp"

namespace stokes {

namespace {

// Throws if a limit does not hold; the key must have been given then.
struct Limit {
  const GivenKeys& given;

  void operator()(bool holds, const std::string& key, std::string_view why) const {
    if (!holds) refuse(key, given.at(key), why);
  }
};

// A key without effect is refused, with two exceptions. If an argument for another key makes a value of the file idle, this
// is a warning, because arguments try variants of one file. If a value of the file is the default, nothing is reported.
void check_effects(Case& c, const GivenKeys& given) {
  const Case defaults;
  for (const CaseKey& key : case_keys()) {
    const auto value = given.find(key.name);
    const Condition* const idle = value == given.end() ? nullptr : key.idle_for(c);
    if (!idle || (!value->second.in_argument && key.get(c) == key.get(defaults))) continue;
    const auto decider = given.find(idle->key);
    const bool by_argument = decider != given.end() && decider->second.in_argument && !value->second.in_argument;
    if (!by_argument) refuse(key.name, value->second, idle->otherwise);
    if (idle->key == "start_from") continue;  // it is given to replace them
    c.warnings.push_back(concat(value->second.where, ": ", key.name, " = ", quote(value->second.text), " has no effect: ",
                                decider->second.where));
  }
}

// Limits in unbounded fluid.
void check_flow(const Case& c, const Limit& limit) {
  if (c.flow == FlowKind::linear) {
    limit(limit.given.contains("gradient"), "flow", "needs gradient = a b c d for u = rate (a x + b y, c x + d y).");
    limit(c.gradient.size() == 4, "gradient", "must be four numbers, du/dx du/dy dv/dx dv/dy, such as 0 1 0 0.");
    const double size = std::abs(c.gradient[0]) + std::abs(c.gradient[3]), trace = c.gradient[0] + c.gradient[3];
    limit(std::abs(trace) <= 1e-12 * size, "gradient",
          concat("has a + d = ", brief(trace), ", but the fluid is incompressible: a + d must be 0."));
    limit(c.background().gradient.largest() > 0.0, "gradient", "is zero; write flow = none.");
  }
  if (c.sample_area) limit(*c.sample_area > 0.0, "sample_area", "must be greater than 0, or none.");
}

void check_geometry(const Case& c, const Limit& limit) {
  if (c.geometry == Geometry::unbounded) return check_flow(c, limit);
  limit(c.flow == FlowKind::none, "flow",
        "is a flow of unbounded fluid, but in an annulus or disc the walls drive the fluid; leave it out.");
  limit(c.outer_radius <= 1e100, "outer_radius", "is above 1e100; choose a larger unit of length.");
  if (c.geometry == Geometry::annulus) {
    limit(c.inner_radius > 0.0, "inner_radius", "must be greater than 0.");
    limit(c.outer_radius > c.inner_radius, "outer_radius",
          concat("must be greater than inner_radius = ", c.inner_radius, "; exchange them or move the walls apart."));
  } else {
    limit(c.outer_radius > 0.0, "outer_radius", "must be greater than 0.");
  }
  limit(c.wall_points >= 16, "wall_points", "is below 16; try 256.");
  limit(c.wall_points % 2 == 0, "wall_points", "is odd; it must be even, try one more.");
  limit(c.wall_points <= 65536, "wall_points", "is above 65536; try 1024.");
}

// Nodes chosen by an accuracy, or fixed nodes.
void check_resolution(const Case& c, const Limit& limit) {
  if (!c.accuracy) {
    limit(c.points_per_body >= 8, "points_per_body", "is below 8; try 32.");
    limit(c.points_per_body % 2 == 0, "points_per_body", "is odd; it must be even, try one more.");
    // The block of one shape would need more than 100 GB.
    limit(c.points_per_body <= 65536, "points_per_body", "is above 65536; try 1024.");
    return;
  }
  limit(*c.accuracy >= 1e-11 && *c.accuracy <= 0.1, "accuracy", "must be between 1e-11 and 0.1; try 1e-4.");
  for (const char* key : {"points_per_body", "wall_points", "refine", "gmres_tolerance"})
    limit(!limit.given.contains(key), key, concat("is chosen by accuracy = ", *c.accuracy, "; keep one of them."));
  limit(c.coupling == Coupling::global, "coupling", "needs fixed nodes; give points_per_body instead of accuracy.");
  limit(c.near_singular == NearSingular::cauchy, "near_singular",
        "needs fixed nodes; give points_per_body instead of accuracy.");
  limit(c.min_separation == 0.0, "min_separation", "is in units of points_per_body; give min_separation_length.");
  limit(c.contact != ContactModel::stiv || c.stiv_vertices > 0, "contact",
        "has 4 vertices for each of points_per_body; give stiv_vertices, too.");
}

void check_output(const Case& c, const Limit& limit) {
  limit(c.output_every >= 1, "output_every", "must be at least 1, which writes every step.");
  std::string obstacle = why_not_writable(c.output);
  if (obstacle.empty() && c.vtk) obstacle = why_not_writable(std::filesystem::path(c.output) / "vtk");
  limit(obstacle.empty(), "output", concat("cannot be the output folder: ", obstacle, "; choose another one."));
  for (std::size_t k = 0; k < c.fields_at.size(); ++k) {
    const double time = c.fields_at[k];
    limit(time >= c.start_time && time <= c.end_time, "fields_at",
          concat("has the time ", time, ", which is not between ", c.start_time, " and end_time = ", c.end_time,
                 "; leave it out."));
    limit(k == 0 || time > c.fields_at[k - 1], "fields_at", "must be in increasing order, each time once.");
  }
  limit(c.field_points >= 2, "field_points", "must be at least 2; try 200.");
  limit(c.field_points <= 10000, "field_points", "is above 10000, more than 1e8 points; try 200.");
  limit(c.checkpoint_every >= 0.0, "checkpoint_every", "must be at least 0; 0 makes none at intervals.");
}

void check_separation(const Case& c, const Limit& limit) {
  limit(c.min_separation >= 0.0, "min_separation", "must be at least 0.");
  limit(c.min_separation <= 1e100, "min_separation", "is above 1e100, more than any suspension has room for; try 1.");
  if (c.min_separation_length) {
    limit(*c.min_separation_length >= 0.0, "min_separation_length", "must be at least 0.");
    limit(*c.min_separation_length <= 1e100, "min_separation_length", "is above 1e100; choose a larger unit of length.");
    if (const auto other = limit.given.find("min_separation"); other != limit.given.end())
      limit(false, "min_separation_length",
            concat("and min_separation = ", quote(other->second.text), " (", other->second.where,
                   ") set the same thing; keep one of them."));
  }
}

// Integrators other than forward Euler need the complete fluid and exact gaps; a tolerance needs more accurate solutions.
void check_integrator(const Case& c, const Limit& limit) {
  if (c.integrator != IntegratorKind::euler) {
    limit(c.coupling == Coupling::global, "coupling", "needs integrator = euler: its densities lag one step behind.");
    limit(c.contact != ContactModel::stiv, "contact",
          "needs integrator = euler: interference volumes are measured along the way from the start of a step.");
  }
  if (!c.tolerance) return;
  limit(*c.tolerance >= 1e-10 && *c.tolerance <= 0.1, "tolerance", "must be between 1e-10 and 0.1; try 1e-4.");
  limit(c.adaptive, "adaptive", "contradicts tolerance, which chooses the steps; leave one of them out.");
  const double largest = solver_part * *c.tolerance * (1.0 + 1e-12);
  if (c.accuracy)
    limit(*c.accuracy <= largest, limit.given.contains("accuracy") ? "accuracy" : "tolerance",
          concat("must leave a tenth of tolerance = ", *c.tolerance,
                 " to the solutions; try accuracy = ", solver_part * *c.tolerance, "."));
  else
    limit(c.gmres_tolerance <= largest, limit.given.contains("gmres_tolerance") ? "gmres_tolerance" : "tolerance",
          concat("must leave a tenth of tolerance = ", *c.tolerance, " to the solutions; try gmres_tolerance = ",
                 solver_part * *c.tolerance, "."));
}

}  // namespace

void check_case(Case& c, const GivenKeys& given) {
  const Limit limit{given};
  check_geometry(c, limit);
  check_resolution(c, limit);
  check_integrator(c, limit);
  limit(c.time_step > 0.0, "time_step", "must be greater than 0; a flow backwards has a negative rate.");
  limit(c.end_time > 0.0, "end_time", "must be greater than 0; a flow backwards has a negative rate.");
  limit(c.end_time > c.start_time, "end_time",
        concat("is not after the start at ", c.start_time, "; give a later one: it is no duration."));
  // Steps are counted by an int.
  limit((c.end_time - c.start_time) / c.time_step < 2e9, "time_step",
        concat("makes more than 2e9 steps to end_time = ", c.end_time, "; take a larger step."));
  if (c.reverse_at) limit(*c.reverse_at >= 0.0, "reverse_at", "must be at least 0, or none.");
  check_separation(c, limit);
  limit(c.gmres_tolerance > 0.0 && c.gmres_tolerance < 1.0, "gmres_tolerance",
        "must be greater than 0 and less than 1; try 1e-8.");
  limit(c.stiv_vertices == 0 || c.stiv_vertices >= 8, "stiv_vertices",
        "must be at least 8, or 0 for 4 points_per_body.");
  limit(c.stiv_vertices <= 65536, "stiv_vertices", "is above 65536; try 128.");
  // Below the error of the sums themselves GMRES would solve for this error, not for the flow.
  limit(c.summation != Summation::fmm || c.gmres_tolerance >= 1e-11, "gmres_tolerance",
        "is below 1e-11, which multipole sums with their error of 1e-12 cannot serve; take summation = direct.");
  check_output(c, limit);
  if (c.threads) {
    limit(*c.threads >= 1, "threads", "must be at least 1; leave it out for all cores.");
    limit(*c.threads <= most_threads, "threads", concat("is above ", most_threads, "; leave it out for all cores."));
  }
  check_effects(c, given);
}

}  // namespace stokes
