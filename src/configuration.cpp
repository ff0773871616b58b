#include "configuration.hpp"

#include <algorithm>

#include "completion.hpp"

namespace stokes {

namespace {

// The mobility across a small gap is at most 1e-3 of the contribution of each of the two flows in it.
constexpr double column_tolerance = 1e-6;

bool same(const std::vector<Wrench>& u, const std::vector<Wrench>& v) {
  return std::equal(u.begin(), u.end(), v.begin(), v.end(),
                    [](const Wrench& a, const Wrench& b) { return a.force == b.force && a.torque == b.torque; });
}

}  // namespace

std::vector<Discretisation> given_nodes(const Suspension& bodies, const StepperOptions& options) {
  std::vector<Discretisation> nodes = options.refine == Refine::near
                                          ? refined_nodes(bodies, options.points_per_body, near_tolerance)
                                          : equal_nodes(bodies, options.points_per_body);
  if (bodies.container) nodes.push_back({bodies.container->points, {}});
  return nodes;
}

Configuration::Configuration(Suspension bodies, double path, double driving, Fluid& fluid, const FluidMemory& memory)
    : bodies_(std::move(bodies)), path_(path), driving_(driving), fluid_(fluid) {
  StokesSolution solution = solve_contact_free(memory);
  effort().gmres_iterations += solution.iterations;
  background_iterations_ = solution.iterations;
  data_norm_ = solution.data_norm;
  contact_free_ = {std::move(solution.velocity), std::move(solution.density)};
}

StokesSolution Configuration::solve_contact_free(const FluidMemory& memory) {
  const StepperOptions& options = fluid_.options;
  const BackgroundFlow flow = options.flow.driven(driving_);
  std::vector<Wrench> external;
  for (const Body& body : bodies_) external.push_back({body.force, body.torque});
  const auto guess = [&](const std::vector<Discretisation>& nodes) {
    return ComplexVector(driving_ * memory.background.extrapolated(path_, nodes));
  };
  if (options.accuracy > 0.0) {
    resolution_ = memory.resolution;
    ResolvedSystem resolved = solve_to_accuracy({bodies_, flow, external, guess}, options.accuracy, options.stokes,
                                                fluid_.shapes, fluid_.alone, resolution_);
    nodes_ = std::move(resolved.nodes);
    system_ = std::move(resolved.system);
    estimated_error_ = resolved.error;
    unresolved_ = static_cast<int>(resolved.unresolved.size());
    effort().stokes_solves += resolved.solves;
    return std::move(resolved.solution);
  }
  nodes_ = given_nodes(bodies_, options);
  shortfalls_ = stokes::shortfalls(bodies_, nodes_, fluid_.alone);
  unresolved_ = static_cast<int>(shortfalls_.size());
  system_ = std::make_unique<StokesSystem>(bodies_, nodes_, fluid_.shapes, options.stokes);
  effort().stokes_solves += 1;
  if (options.coupling == Coupling::local && memory.total.value.size() > 0)
    return system_->sweep(flow, external, memory.total.on(nodes_));
  return system_->solve(flow, external, guess(nodes_));
}

const Response& Configuration::respond(const std::vector<Wrench>& wrenches, const ComplexVector& guess, double scale) {
  for (const auto& [known, response] : answers_)
    if (same(known, wrenches)) return response;
  StokesSolution solution = system_->solve({}, wrenches, guess, scale);
  effort().gmres_iterations += solution.iterations;
  ++effort().stokes_solves;
  answers_.push_back({wrenches, {std::move(solution.velocity), std::move(solution.density)}});
  return answers_.back().second;
}

Response Configuration::respond_nearby(const std::vector<Wrench>& wrenches) const {
  StokesSolution solution = system_->solve_nearby(wrenches, column_tolerance);
  return {std::move(solution.velocity), std::move(solution.density)};
}

Response Configuration::respond_alone(const std::vector<Wrench>& wrenches) const {
  Response response{{}, ComplexVector::Zero(system_->node_count())};
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    response.velocity.push_back(completion_trace(bodies_[i].shape, bodies_[i].pose, wrenches[i]));
  return response;
}

}  // namespace stokes
